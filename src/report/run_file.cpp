#include "flute_grinder/report/run_file.h"

#include "flute_grinder/job/file_error.h"
#include "flute_grinder/job/regular_file.h"
#include "report/bag_run.h"
#include "report/csv_run.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

namespace grinder {

namespace {

constexpr std::uint64_t kMinRows = 3;
constexpr char kBagHead[] = "#ROSBAG ";

}  // namespace

FileKind kindOf(const std::string& path) {
  requireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  std::string head(200, '\0');
  if (!file || file.read(head.data(), static_cast<std::streamsize>(head.size())).bad())
    throw FileError(path + ": cannot be read: " + std::strerror(errno));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (head.compare(0, sizeof kBagHead - 1, kBagHead) == 0) return FileKind::kBag;
  const std::size_t begin = head.find_first_not_of(" \t\r\n");
  if (begin != std::string::npos && head[begin] == '{') return FileKind::kRecord;
  return kindOfCsv(head.substr(0, head.find_first_of("\r\n")));
}

std::unique_ptr<RunFile> RunFile::open(const std::string& path, int job) {
  const FileKind kind = kindOf(path);
  if (kind == FileKind::kBag) return std::make_unique<BagRun>(path, job);
  if (job != 0) throw FileError(path + ": job " + std::to_string(job) + ": only a bag has several jobs");
  return std::make_unique<CsvRun>(path, kind);
}

void RunFile::fail(const std::string& reason) const { throw FileError(path_ + ": " + reason); }

void RunFile::restart() {
  summary_ = RowSummary();
  last_cycle_ = -1;
}

void RunFile::summarise(const RunRow& row) {
  const Setpoint& s = row.setpoint;
  const auto cycle = static_cast<std::int64_t>(s.cycle);
  const std::string named = "cycle " + std::to_string(s.cycle);
  if (cycle <= last_cycle_)
    fail(named + " follows cycle " + std::to_string(last_cycle_) + "; allowed: ascending cycles");
  // The position read may be NaN, of a faulty drive: the report of its job is wanted most.
  const auto require = [&](bool finite, const char* name) {
    if (!finite) fail(named + ": " + name + " is not a finite number");
  };
  require(s.position.allFinite(), "position");
  require(std::isfinite(s.path_error), "error");
  require(std::isfinite(s.feed), "feed");
  require(std::isfinite(row.cycle_period), "cycle_period");
  RowSummary& all = summary_;
  if (all.count++ == 0) {
    all.first_cycle = s.cycle;
    all.first = s.position;
    all.begin = row.time;
  }
  all.end = row.time;
  all.missing += static_cast<std::uint64_t>(cycle - last_cycle_ - 1);
  last_cycle_ = cycle;
  if (s.step == StepKind::kNone) return;
  const double error = std::abs(s.path_error), x = s.position[kX];
  if (!all.worst || error > std::max(all.odd_error, all.even_error)) all.worst = ToothPass{s.tooth, s.pass};
  double& max_error = s.step == StepKind::kOdd ? all.odd_error : all.even_error;
  max_error = std::max(max_error, error);
  all.min_x = std::min(all.min_x, x);
  all.max_x = std::max(all.max_x, x);
}

void RunFile::finish() const {
  if (summary_.count >= kMinRows) return;
  fail("has " + (summary_.count == 0 ? "no points" : std::to_string(summary_.count) + " point(s)") +
       "; allowed: 3 or more");
}

}  // namespace grinder
