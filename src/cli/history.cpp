#include "cli/history.h"

#include "cli/csv.h"
#include "cli/machine_file.h"
#include "cli/time_text.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/on_all_cores.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/plan/job_digest.h"
#include "flute_grinder/record/record_file.h"
#include "flute_grinder/record/verdict.h"

#include <ros/names.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace grinder {

namespace {

/// What is listed of a record.
struct Entry {
  std::string file;
  std::string grinder;  ///< its folder, as given
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

/// Of the job in a record's summary.
std::string operationOf(const Json& job) {
  if (!job.contains("operations")) return "";
  const auto kind = valueOf<OperationKind>(job.at("operation").get<std::string>());
  if (!kind) throw std::runtime_error("operation = " + job["operation"].get<std::string>() + " is none");
  return rowOf(*kind).words;
}

std::string toolOf(const Json& cutter) {
  const auto angle = [&](const char* key) { return cutter.at(key).get<double>() * units::kDegree; };
  const bool equal = cutter.contains("spiral_angle_deg");
  CutterGeometry geometry;
  geometry.end_diameter = cutter.at("end_diameter_mm").get<double>() * units::kMillimetre;
  geometry.cone_angle = angle("cone_angle_deg");
  geometry.spiral_angle =
      equal ? angle("spiral_angle_deg") : cutter.at("spiral_angles_deg").at(0).get<double>() * units::kDegree;
  geometry.rake_angle = angle("rake_angle_deg");
  return toolText(geometry,
                  cutter.contains("teeth") ? cutter["teeth"].get<std::size_t>() : cutter.at("tooth_angles_deg").size());
}

/// Which records are listed.
class Filter {
 public:
  explicit Filter(const HistoryOptions& options)
      : options_(options),
        first_(options.since.empty() ? "" : startText(timeOfDate(options.since, false))),
        last_(options.until.empty() ? "~" : startText(timeOfDate(options.until, true))) {
    if (first_ > last_) {
      throw std::invalid_argument("--until " + options.until + " is before --since " + options.since +
                                  "; allowed: the same or later");
    }
  }

  /// By the start in its file's name.
  bool takes(std::string_view path) const { return first_ <= startOf(path) && startOf(path) <= last_; }
  bool takesTool(const Entry& entry) const {
    return options_.tool.empty() || contains(entry.job) || contains(entry.tool);
  }
  bool takesVerdict(const Entry& entry) const { return options_.verdict.empty() || entry.verdict == options_.verdict; }

 private:
  /// Upper or lower case.
  bool contains(const std::string& text) const {
    const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    return std::search(text.begin(), text.end(), options_.tool.begin(), options_.tool.end(), same) != text.end();
  }

  const HistoryOptions& options_;
  const std::string first_, last_;
};

/// @return nothing if it is filtered out. @throw std::exception if it is no record.
std::optional<Entry> readEntry(const std::string& path, const std::string& grinder, const Tolerances& tolerances,
                               const Filter& filter) {
  Json record = readRecordSummary(path);
  const Json& job = record["job"].at("file");
  Entry entry;
  entry.file = path;
  entry.grinder = grinder;
  entry.started = record["started"];
  entry.job = record["job"].at("name");
  entry.operation = operationOf(job);
  entry.tool = toolOf(job.at("cutter"));
  if (!filter.takesTool(entry)) return std::nullopt;
  entry.outcome = record["outcome"];
  entry.reason = record.at("reason");
  entry.strokes = record["complete_strokes"];
  entry.holds = record["holds"];
  Verdict verdict = verdictOnRecord(record, tolerances);
  entry.duration = record["duration_s"];
  entry.verdict = std::move(verdict.verdict);
  entry.because = std::move(verdict.because);
  entry.passes = record["passes"];
  if (!filter.takesVerdict(entry)) return std::nullopt;
  return entry;
}

Json toJson(const Entry& entry) {
  return {{"file", entry.file},       {"grinder", entry.grinder},        {"started", entry.started},
          {"job", entry.job},         {"operation", entry.operation},    {"tool", entry.tool},
          {"outcome", entry.outcome}, {"reason", entry.reason},          {"strokes", entry.strokes},
          {"passes", entry.passes},   {"duration_s", entry.duration},    {"holds", entry.holds},
          {"verdict", entry.verdict}, {"verdict_because", entry.because}};
}

/// In short; what failed is named.
std::string verdictText(const Entry& entry) {
  if (entry.verdict == "incomplete") return "passed as far as measured";
  if (entry.verdict != "failed") return entry.verdict;
  std::string reasons;
  for (const std::string& reason : entry.because) reasons += (reasons.empty() ? ": " : "; ") + reason;
  return "FAILED" + reasons;
}

using Row = std::array<std::string, 9>;

Row toRow(const Entry& entry) {
  return {timeText(timeOf(entry.started), false),
          entry.grinder,
          (entry.job.empty() ? "-" : entry.job) + (entry.operation.empty() ? "" : ", " + entry.operation),
          entry.tool,
          entry.outcome,
          format("%zu of %zu", entry.strokes, entry.passes),
          format("%.1f s", entry.duration),
          std::to_string(entry.holds),
          verdictText(entry)};
}

/// @param grinders whether the table has a column for them.
void printTable(const std::vector<Row>& rows, bool grinders) {
  std::array<std::size_t, std::tuple_size_v<Row>> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      if (i != 1 || grinders) std::printf("%-*s  ", static_cast<int>(widths[i]), row[i].c_str());
    }
    std::printf("%s\n", row.back().c_str());
  }
}

/// The fields of a CSV line; a list is one field. @param take of an entry's member what the line has.
template <typename Take>
std::string csvLine(const Json& entry, const Take& take) {
  std::string line;
  for (const auto& [key, value] : entry.items()) line += (line.empty() ? "" : ",") + take(key, value);
  return line;
}

std::string csvField(const Json& value) {
  std::string plain;
  if (value.is_number()) return grinder::text(value, -1);
  if (value.is_string()) plain = value;
  for (const Json& item : value.is_array() ? value : Json::array()) {
    plain += (plain.empty() ? "" : "; ") + item.get<std::string>();
  }
  std::string field = "\"";
  for (const char c : plain) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

/// A line for each record, with the keys of the JSON as the first.
class HistoryCsv : public CsvFile {
 public:
  explicit HistoryCsv(const std::string& path)
      : CsvFile(path, csvLine(toJson(Entry()), [](const std::string& key, const Json&) { return key; })) {}
  void write(const std::string& line) { print("%s\n", line.c_str()); }
};

/// An entry as it is printed and written.
struct Lines {
  Row row;
  std::string json, csv;
};

/// Prints entries as they come, as JSON, or all at the end as a table, whose columns are as wide as they need; and
/// writes them as CSV if asked to.
class Listing {
 public:
  explicit Listing(const HistoryOptions& options) : json_(options.json), grinders_(options.folders.size() > 1) {
    if (!options.csv.empty()) csv_.emplace(options.csv);
  }

  /// What add() needs of an entry. Thread safe.
  Lines linesOf(const Entry& entry) const {
    Lines lines;
    if (!json_) lines.row = toRow(entry);
    if (!json_ && !csv_) return lines;
    const Json json = toJson(entry);
    if (json_) lines.json = grinder::text(json, -1);
    if (csv_) lines.csv = csvLine(json, [](const std::string&, const Json& value) { return csvField(value); });
    return lines;
  }

  void add(Lines&& lines) {
    if (json_) std::printf("%s%s", count_ == 0 ? "[\n" : ",\n", lines.json.c_str());
    if (!json_) rows_.push_back(std::move(lines.row));
    if (csv_) csv_->write(lines.csv);
    ++count_;
  }

  /// @param none what is said in place of an empty table; empty to print that.
  void end(const std::string& none) {
    if (csv_) csv_->close();
    if (json_) {
      std::printf("%s", count_ == 0 ? "[]\n" : "\n]\n");
    } else if (count_ == 0 && !none.empty()) {
      std::printf("%s\n", none.c_str());
    } else {
      printTable(rows_, grinders_);
    }
  }

 private:
  const bool json_, grinders_;
  std::optional<HistoryCsv> csv_;
  std::size_t count_ = 0;
  std::vector<Row> rows_{{"start", "grinder", "job", "tool", "outcome", "strokes", "duration", "holds", "verdict"}};
};

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
                    "; allowed: --from, if the grinder keeps its records elsewhere");
  }
}

/// A record to read.
struct Record {
  std::string path;
  const std::string* grinder;  ///< outlives this
  std::string place;           ///< its start, or that of one written after it by the same grinder, if that is earlier
};

struct Folder {
  std::string path;
  std::string grinder;
};

/// @throw std::exception if there is no folder of the grinder that is asked for.
std::vector<Folder> foldersOf(const std::string& node, const HistoryOptions& options) {
  if (options.folders.empty()) return {{historyFolder(node), node}};
  std::vector<Folder> folders;
  std::string all;
  for (std::string path : options.folders) {
    while (path.size() > 1 && path.back() == '/') path.pop_back();
    const std::filesystem::path parts(path);
    const bool asked = options.grinder.empty() || std::find(parts.begin(), parts.end(), options.grinder) != parts.end();
    if (asked) folders.push_back({path, path});
    all += (all.empty() ? "" : ", ") + path;
  }
  if (folders.empty()) {
    throw std::invalid_argument("--grinder " + options.grinder +
                                ": no folder of --from has it in its path; allowed: of " + all);
  }
  return folders;
}

/// The records of all folders, the newest last: those of a folder in their order, also if the clock was once ahead.
/// Prints why a folder cannot be read. @return whether all could.
bool findRecords(const std::vector<Folder>& folders, std::vector<Record>& records) {
  bool good = true;
  for (const Folder& folder : folders) {
    try {
      const std::size_t first = records.size();
      for (const std::string& path : pathsIn(folder.path)) {
        records.push_back({path, &folder.grinder, std::string(startOf(path))});
      }
      for (std::size_t i = records.size(); i-- > first + 1;) {
        records[i - 1].place = std::min(records[i - 1].place, records[i].place);
      }
    } catch (const FileError& error) {
      std::fprintf(stderr, "%s\n", error.what());
      good = false;
    }
  }
  const auto older = [](const Record& a, const Record& b) { return a.place < b.place; };
  std::stable_sort(records.begin(), records.end(), older);
  return good;
}

/// What has become of a record.
struct Read {
  std::optional<Lines> lines;  ///< nothing if it is filtered out
  std::string error;           ///< why it could not be read; empty if it could
};

Read readOne(const Record& record, const Tolerances& tolerances, const Filter& filter, const Listing& listing) {
  try {
    const std::optional<Entry> entry = readEntry(record.path, *record.grinder, tolerances, filter);
    return {entry ? std::optional<Lines>(listing.linesOf(*entry)) : std::nullopt, ""};
  } catch (const std::exception& error) {
    std::string reason = error.what();
    if (reason.rfind(record.path, 0) != 0) reason = record.path + ": is no record of a job: " + reason;
    return {std::nullopt, reason.substr(0, reason.find('\n'))};
  }
}

/// Reads records on all cores. @param read a record. @param take what has become of each, in order.
template <typename ReadOne, typename Take>
void readAll(const std::vector<Record>& records, const ReadOne& read, const Take& take) {
  constexpr std::size_t block = 1024;  // bounds the memory
  std::vector<Read> done;
  for (std::size_t begin = 0; begin < records.size(); begin += block) {
    done.assign(std::min(block, records.size() - begin), {});
    onAllCores(done.size(), [&](std::size_t i) { done[i] = read(records[begin + i]); });
    std::for_each(done.begin(), done.end(), take);
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
    if (home.empty()) throw std::runtime_error("HOME is not set; allowed: --from FOLDER");
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
  const Filter filter(options);
  const std::vector<Folder> folders = foldersOf(node, options);
  const Tolerances tolerances =
      readTolerances(options.tolerances.empty() ? packageFile("config/tolerances.yaml") : options.tolerances);
  Listing listing(options);
  std::vector<Record> records;
  int status = findRecords(folders, records) ? 0 : 2;
  if (status != 0 && folders.size() == 1) return status;
  std::string none = records.empty() ? "no records in" : "no such records in";
  for (const Folder& folder : folders) none += (&folder == &folders.front() ? " " : ", ") + folder.path;
  const auto is_other = [&](const Record& record) { return !filter.takes(record.path); };
  records.erase(std::remove_if(records.begin(), records.end(), is_other), records.end());
  readAll(
      records, [&](const Record& record) { return readOne(record, tolerances, filter, listing); },
      [&](Read& read) {
        if (read.lines) listing.add(std::move(*read.lines));
        if (read.error.empty()) return;
        std::fprintf(stderr, "%s\n", read.error.c_str());
        status = 2;
      });
  listing.end(status == 0 ? none : "");
  return status;
}

}  // namespace grinder
