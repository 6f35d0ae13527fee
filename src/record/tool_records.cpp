#include "flute_grinder/record/tool_records.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/z_law.h"
#include "record/ground_strokes.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

/// A run of an operation: the record that began it, and the records that continued it.
struct Run {
  int operation;
  std::vector<std::string> paths;
};

/// The runs of a job's operations in a folder, in order. @param operations operations by their digests.
std::vector<Run> runsIn(const std::string& folder, const std::map<std::string, int>& operations) {
  std::vector<Run> runs;
  for (const std::string& path : recordFilesIn(folder).records) {
    try {
      const RecordHead head = readHead(path);
      const auto found = operations.find(head.digest);
      if (found == operations.end()) continue;
      const bool goes_on = head.continues && !runs.empty() && runs.back().operation == found->second;
      if (!goes_on) runs.push_back({found->second, {}});
      runs.back().paths.push_back(path);
    } catch (const FileError&) {
      // An unreadable record, which `grind history` names, does not count.
    }
  }
  return runs;
}

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

bool isSame(const std::string& a, const std::string& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error);
}

/// Where the wheel was in a run of a job. @param job with its laws.
RunStrokes groundStrokes(const ValidJob& job, const std::vector<Record>& records, std::optional<GroundCutter> before) {
  std::vector<RunStroke> strokes;
  for (const Record& record : records) {
    const auto& reason = record.body.at("not_ground").get_ref<const std::string&>();
    if (!reason.empty()) throw std::invalid_argument(reason);
    for (RunStroke& stroke : runStrokesFrom(record.body.at("ground"))) strokes.push_back(std::move(stroke));
  }
  return {job, std::move(strokes), std::move(before)};
}

}  // namespace

ToolRecords::ToolRecords(const std::string& path) : folder_(folderOf(path)) {
  const GrindJob job = parseJob(readRecord(path).body.at("job_file").dump(), path);
  std::map<std::string, int> by_digest;
  for (const GrindJob& operation : job.ofAllOperations()) {
    operations_.push_back({operation, {}, {}, {}});
    by_digest[jobDigest(operation)] = operation.operation;
  }
  std::vector<Run> runs = runsIn(folder_, by_digest);
  const auto has_path = [&](const Run& run) {
    return std::any_of(run.paths.begin(), run.paths.end(), [&](const std::string& one) { return isSame(one, path); });
  };
  auto own = std::find_if(runs.begin(), runs.end(), has_path);
  // A record without the name of a record stands for itself.
  if (own == runs.end()) own = runs.insert(own, {job.operation, {path}});
  const auto take = [&](const Run& run) {
    Operation& operation = operations_[static_cast<std::size_t>(run.operation)];
    operation.job = withLaws(ValidJob(operation.asked));
    for (const std::string& one : run.paths) {
      operation.files.push_back(std::filesystem::path(one).filename());
      operation.records.push_back(readRecord(one));
    }
  };
  take(*own);
  own_ = static_cast<std::size_t>(own->operation);
  for (auto run = own; run != runs.begin() && std::prev(run)->operation == run->operation - 1; --run) {
    take(*std::prev(run));
  }
  auto run = own;
  for (; std::next(run) != runs.end() && std::next(run)->operation == run->operation + 1; ++run) take(*std::next(run));
  last_ = static_cast<std::size_t>(run->operation);
}

std::vector<ToothPass> ToolRecords::Operation::missing() const {
  std::vector<ToothPass> places;
  if (!job) return places;
  for (const JobPass& pass : job->passes()) places.push_back(pass.place);
  for (const Record& record : records) {
    for (const Json& stroke : record.body.at("strokes")) {
      const ToothPass place{stroke.at("tooth").get<int>() - 1, stroke.at("pass").get<int>() - 1};
      if (!stroke.at("complete").get<bool>()) continue;
      places.erase(std::remove(places.begin(), places.end(), place), places.end());
    }
  }
  return places;
}

RunStrokes ToolRecords::strokes(const Operation& operation) const {
  std::optional<GroundCutter> ground;
  const auto is_known = [](const Operation& ahead) { return !ahead.records.empty(); };
  const auto own = operations_.begin() + (&operation - operations_.data());
  if (std::all_of(operations_.begin(), own, is_known)) {
    for (auto ahead = operations_.begin(); ahead != own; ++ahead) {
      ground = groundStrokes(*ahead->job, ahead->records, std::exchange(ground, std::nullopt)).cutter();
    }
  }
  return groundStrokes(*own->job, own->records, std::move(ground));
}

}  // namespace grinder
