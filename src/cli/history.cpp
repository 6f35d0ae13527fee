#include "cli/history.h"

#include "cli/csv.h"
#include "cli/json_output.h"
#include "cli/machine_file.h"
#include "cli/time_text.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/plan/job_digest.h"
#include "flute_grinder/record/record_file.h"
#include "flute_grinder/record/verdict.h"

#include <ros/names.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace grinder {

namespace {

/// What is listed of a record.
struct Entry {
  std::string file;
  std::string started;  ///< as in the record
  std::string job;
  std::string operation;  ///< as GrindJob::operationText()
  std::string tool;
  std::string outcome, reason;
  std::size_t strokes = 0;  ///< ground to their end
  std::size_t passes = 0;   ///< of the job, from the first to grind on
  double duration = 0;      ///< [s]
  std::size_t holds = 0;
  std::string verdict;
  std::vector<std::string> because;
};

/// The passes of a job from a first one on, whose tooth and pass count from 1 here.
std::size_t passesFrom(const ValidJob& job, const Json& first) {
  const std::vector<JobPass>& passes = job.passes();
  const auto is_first = [&](const JobPass& p) {
    return p.place.tooth + 1 == first.at("tooth") && p.place.pass + 1 == first.at("pass");
  };
  const auto begin = std::find_if(passes.begin(), passes.end(), is_first);
  if (begin == passes.end()) throw std::runtime_error("first: no pass of the job");
  return static_cast<std::size_t>(passes.end() - begin);
}

/// @throw std::exception if it is no record.
Entry readEntry(const std::string& path, const Tolerances& tolerances) {
  Json record = readRecord(path);
  const GrindJob job = parseJob(record.at("job").at("file").dump(), "job.file");
  const Json& strokes = record.at("strokes");
  Entry entry;
  entry.file = path;
  entry.started = record.at("started");
  entry.job = record.at("job").at("name");
  entry.operation = job.operationText();
  entry.tool = toolText(job.cutter, job.tooth_angles.size());
  entry.outcome = record.at("outcome");
  entry.reason = record.at("reason");
  entry.strokes = static_cast<std::size_t>(std::count_if(
      strokes.begin(), strokes.end(), [](const Json& stroke) { return stroke.at("complete").get<bool>(); }));
  entry.passes = passesFrom(ValidJob(job), record.at("first"));
  entry.holds = record.at("holds").size();
  judgeRecord(record, tolerances);
  entry.duration = record["duration_s"];
  entry.verdict = record["verdict"];
  entry.because = record["verdict_because"].get<std::vector<std::string>>();
  return entry;
}

Json toJson(const Entry& entry) {
  return {{"file", entry.file},
          {"started", entry.started},
          {"job", entry.job},
          {"operation", entry.operation},
          {"tool", entry.tool},
          {"outcome", entry.outcome},
          {"reason", entry.reason},
          {"strokes", entry.strokes},
          {"passes", entry.passes},
          {"duration_s", entry.duration},
          {"holds", entry.holds},
          {"verdict", entry.verdict},
          {"verdict_because", entry.because}};
}

/// In short; what failed is named.
std::string verdictText(const Entry& entry) {
  if (entry.verdict == "incomplete") return "passed as far as measured";
  if (entry.verdict != "failed") return entry.verdict;
  std::string reasons;
  for (const std::string& reason : entry.because) reasons += (reasons.empty() ? ": " : "; ") + reason;
  return "FAILED" + reasons;
}

using Row = std::array<std::string, 8>;

Row toRow(const Entry& entry) {
  return {timeText(timeOf(entry.started), false),
          (entry.job.empty() ? "-" : entry.job) + (entry.operation.empty() ? "" : ", " + entry.operation),
          entry.tool,
          entry.outcome,
          format("%zu of %zu", entry.strokes, entry.passes),
          format("%.1f s", entry.duration),
          std::to_string(entry.holds),
          verdictText(entry)};
}

void printTable(const std::vector<Entry>& entries) {
  std::vector<Row> rows{{"start", "job", "tool", "outcome", "strokes", "duration", "holds", "verdict"}};
  std::transform(entries.begin(), entries.end(), std::back_inserter(rows), toRow);
  std::array<std::size_t, std::tuple_size_v<Row>> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i) std::printf("%-*s  ", static_cast<int>(widths[i]), row[i].c_str());
    std::printf("%s\n", row.back().c_str());
  }
}

/// Of the records, the newest last. Prints what is skipped.
std::vector<std::string> pathsIn(const std::string& folder) {
  try {
    const RecordFiles files = recordFilesIn(folder);
    for (const std::string& path : files.others) {
      std::fprintf(stderr, "%s: skipped: named like a record, but not a regular file\n", path.c_str());
    }
    return files.records;
  } catch (const std::filesystem::filesystem_error& error) {
    throw FileError(folder + ": cannot be read: " + error.code().message() +
                    "; allowed: --folder, if the grinder keeps its records elsewhere");
  }
}

}  // namespace

std::string historyFolder(const std::string& node) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  std::string ros_home = variable("ROS_HOME");
  if (ros_home.empty()) {
    const std::string home = variable("HOME");
    if (home.empty()) throw std::runtime_error("HOME is not set; allowed: --folder FOLDER");
    ros_home = home + "/.ros";
  }
  return ros_home + "/flute_grinder/history" + ros::names::resolve(node);
}

std::optional<std::string> newestRecord(const std::string& folder) {
  const std::vector<std::string> paths = pathsIn(folder);
  if (paths.empty()) return std::nullopt;
  return paths.back();
}

std::string doneOperations(const std::string& node, const std::string& job) {
  GrindJob tool;
  try {
    tool = readJobFile(job, {}, "1");
  } catch (const JobFileError&) {
    return "";
  }
  if (tool.operations.empty()) return "";
  std::vector<std::string> paths;
  try {
    paths = pathsIn(historyFolder(node));
  } catch (const std::runtime_error&) {
    // A grinder that has no folder yet has no records.
  }
  std::map<std::string, std::string> ended;
  for (const std::string& path : paths) {
    try {
      const Json record = readRecord(path);
      if (record["outcome"] == "done") ended[record["job"]["digest"]] = record["ended"];
    } catch (const std::exception&) {
      // `grind history` names it.
    }
  }
  std::string done;
  for (int i = 0; i < static_cast<int>(tool.operations.size()); ++i) {
    const GrindJob operation = tool.ofOperation(i);
    const auto found = ended.find(jobDigest(operation));
    if (found == ended.end()) continue;
    done += (done.empty() ? "" : ", ") + std::string(toString(operation.process.kind)) + " (" +
            timeText(timeOf(found->second), false) + ")";
  }
  return "done by the records: " + (done.empty() ? "none" : done);
}

int printHistory(const std::string& node, const HistoryOptions& options) {
  const std::string folder = options.folder.empty() ? historyFolder(node) : options.folder;
  const Tolerances tolerances =
      readTolerances(options.tolerances.empty() ? packageFile("config/tolerances.yaml") : options.tolerances);
  std::vector<Entry> entries;
  int status = 0;
  for (const std::string& path : pathsIn(folder)) {
    try {
      entries.push_back(readEntry(path, tolerances));
    } catch (const std::exception& error) {
      std::string reason = error.what();
      if (reason.rfind(path, 0) != 0) reason = path + ": is no record of a job: " + reason;
      std::fprintf(stderr, "%s\n", reason.substr(0, reason.find('\n')).c_str());
      status = 2;
    }
  }
  if (options.json) {
    Json list = Json::array();
    for (const Entry& entry : entries) list.push_back(toJson(entry));
    print(list);
  } else if (entries.empty() && status == 0) {
    std::printf("no records in %s\n", folder.c_str());
  } else {
    printTable(entries);
  }
  return status;
}

}  // namespace grinder
