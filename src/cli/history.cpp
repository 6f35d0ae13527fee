#include "cli/history.h"

#include "cli/csv.h"
#include "cli/machine_file.h"
#include "cli/time_text.h"
#include "cli/working.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/on_all_cores.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/record/record_file.h"
#include "flute_grinder/record/tool_records.h"
#include "flute_grinder/record/verdict.h"

#include <ros/names.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace grinder {

namespace {

/// The data of a record to list.
struct Entry {
  std::string file;
  std::string grinder;  ///< folder of the grinder, as given
  RecordHead head;
};

/// Selects the records to list.
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

  /// Whether the start in the file's name is within the dates asked for.
  bool takes(std::string_view path) const { return first_ <= startOf(path) && startOf(path) <= last_; }
  bool takesTool(const RecordHead& head) const {
    return options_.tool.empty() || contains(head.job) || contains(head.tool);
  }
  bool takesVerdict(const RecordHead& head) const {
    return options_.verdict.empty() || head.verdict == options_.verdict;
  }

 private:
  /// Whether a text contains the one asked for, in any case.
  bool contains(const std::string& text) const {
    const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    return std::search(text.begin(), text.end(), options_.tool.begin(), options_.tool.end(), same) != text.end();
  }

  const HistoryOptions& options_;
  const std::string first_, last_;
};

Json toJson(const Entry& entry) {
  Json json{{"file", entry.file}};
  json.update(toJson(entry.head));
  json["grinder"] = entry.grinder;
  return json;
}

/// The verdict in short, with the figures that failed.
std::string verdictText(const RecordHead& head) {
  if (head.verdict == "incomplete") return "passed as far as measured";
  if (head.verdict != "failed") return head.verdict;
  std::string reasons;
  for (const std::string& reason : head.because) reasons += (reasons.empty() ? ": " : "; ") + reason;
  return "FAILED" + reasons;
}

/// The rows of the table, which are held until all are read; compact, for a hundred thousand records.
class Table {
 public:
  using Row = std::array<std::string, 9>;

  void add(const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths_[i] = std::max(widths_[i], row[i].size());
      text_.insert(text_.end(), row[i].c_str(), row[i].c_str() + row[i].size() + 1);
    }
  }

  /// @param grinders whether to print a column for them.
  void print(bool grinders) const {
    std::string cell;
    std::size_t column = 0;
    for (const char c : text_) {
      if (c != '\0') {
        cell += c;
        continue;
      }
      const bool last = column + 1 == widths_.size();
      if (last) std::printf("%s\n", cell.c_str());
      if (!last && (column != 1 || grinders)) std::printf("%-*s  ", static_cast<int>(widths_[column]), cell.c_str());
      column = last ? 0 : column + 1;
      cell.clear();
    }
  }

 private:
  std::array<std::size_t, std::tuple_size_v<Row>> widths_{};
  std::deque<char> text_;  ///< texts of the cells, each with a 0 at its end
};

Table::Row rowOf(const Entry& entry) {
  const RecordHead& head = entry.head;
  return {timeText(timeOf(head.started), false),
          entry.grinder,
          (head.job.empty() ? "-" : head.job) + (head.operation.empty() ? "" : ", " + head.operation),
          head.tool,
          head.outcome,
          format("%ju of %ju", std::uintmax_t{head.strokes}, std::uintmax_t{head.passes}),
          format("%.1f s", head.duration),
          std::to_string(head.holds),
          verdictText(head)};
}

/// The fields of a CSV line; a list is one field. @param take makes a field from a member of the entry.
template <typename Take>
std::string csvLine(const Json& entry, const Take& take) {
  std::string line;
  for (const auto& [key, value] : entry.items()) line += (line.empty() ? "" : ",") + take(key, value);
  return line;
}

std::string csvField(const Json& value) {
  std::string plain;
  if (value.is_number() || value.is_boolean()) return grinder::text(value, -1);
  if (value.is_string()) plain = value;
  for (const Json& item : value.is_array() ? value : Json::array()) {
    plain += (plain.empty() ? "" : "; ") + item.get<std::string>();
  }
  std::string field = "\"";
  for (const char c : plain) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

/// A CSV file with a line for each record; the first line has the keys of the JSON.
class HistoryCsv : public CsvFile {
 public:
  explicit HistoryCsv(const std::string& path)
      : CsvFile(path, csvLine(toJson(Entry()), [](const std::string& key, const Json&) { return key; })) {}
  void write(const std::string& line) { print("%s\n", line.c_str()); }
};

/// An entry as it is printed and written.
struct Lines {
  Table::Row row;
  std::string json, csv;
};

/// Prints entries as JSON, at once, or as a table, at the end, when the columns' widths are known; and writes them as
/// CSV if asked to.
class Listing {
 public:
  explicit Listing(const HistoryOptions& options) : json_(options.json), grinders_(options.folders.size() > 1) {
    if (!options.csv.empty()) csv_.emplace(options.csv);
    table_.add({"start", "grinder", "job", "tool", "outcome", "strokes", "duration", "holds", "verdict"});
  }

  /// The lines of an entry for add(). Thread safe.
  Lines linesOf(const Entry& entry) const {
    Lines lines;
    if (!json_) lines.row = rowOf(entry);
    if (!json_ && !csv_) return lines;
    const Json json = toJson(entry);
    if (json_) lines.json = grinder::text(json, -1);
    if (csv_) lines.csv = csvLine(json, [](const std::string&, const Json& value) { return csvField(value); });
    return lines;
  }

  void add(Lines&& lines) {
    if (json_) std::printf("%s%s", count_ == 0 ? "[\n" : ",\n", lines.json.c_str());
    if (!json_) table_.add(lines.row);
    if (csv_) csv_->write(lines.csv);
    ++count_;
  }

  /// @param none text in place of an empty table; empty to print the empty table.
  void end(const std::string& none) {
    if (csv_) csv_->close();
    if (json_) {
      std::printf("%s", count_ == 0 ? "[]\n" : "\n]\n");
    } else if (count_ == 0 && !none.empty()) {
      std::printf("%s\n", none.c_str());
    } else {
      table_.print(grinders_);
    }
  }

 private:
  const bool json_, grinders_;
  std::optional<HistoryCsv> csv_;
  std::size_t count_ = 0;
  Table table_;
};

FileError unreadable(const std::string& folder, const std::filesystem::filesystem_error& error) {
  return FileError(folder + ": cannot be read: " + error.code().message() +
                   "; allowed: --from, if the grinder keeps its records elsewhere");
}

/// The paths of the records in a folder, the newest last. Prints the names of skipped files.
std::vector<std::string> pathsIn(const std::string& folder) {
  try {
    const RecordFiles files = recordFilesIn(folder);
    for (const std::string& path : files.others) {
      std::fprintf(stderr, "%s: skipped: named like a record, but not a regular file\n", path.c_str());
    }
    return files.records;
  } catch (const std::filesystem::filesystem_error& error) {
    throw unreadable(folder, error);
  }
}

/// A record to read.
struct Listed {
  std::string path;
  const std::string* grinder;  ///< the grinder's name; outlives this object
  std::string_view place;  ///< sorting key: start of this record, or of a later one of the grinder if that is earlier
};

struct Folder {
  std::string path;
  std::string grinder;
};

/// The folders to list. @throw std::exception if the grinder asked for has no folder among them.
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

/// Finds the records of all folders, the newest last. Records of a folder keep their order, even if the clock was once
/// ahead. Prints why a folder cannot be read. @return whether all folders could be read.
bool findRecords(const std::vector<Folder>& folders, std::vector<Listed>& records) {
  bool good = true;
  for (const Folder& folder : folders) {
    try {
      const std::size_t first = records.size();
      for (std::string& path : pathsIn(folder.path)) records.push_back({std::move(path), &folder.grinder, {}});
      // Moving a path does not move its text, which is on the heap.
      for (std::size_t i = first; i < records.size(); ++i) records[i].place = startOf(records[i].path);
      for (std::size_t i = records.size(); i-- > first + 1;) {
        records[i - 1].place = std::min(records[i - 1].place, records[i].place);
      }
    } catch (const FileError& error) {
      std::fprintf(stderr, "%s\n", error.what());
      good = false;
    }
  }
  const auto older = [](const Listed& a, const Listed& b) { return a.place < b.place; };
  std::stable_sort(records.begin(), records.end(), older);
  return good;
}

/// The result of reading a record.
struct Read {
  std::optional<Lines> lines;  ///< nothing if it is filtered out
  std::string error;           ///< why it could not be read; empty if it could
};

/// The tool of a record; nothing if it was measured before or cannot be measured: `grind report` says why.
std::optional<GroundTool> toolOf(const Record& record, const std::string& path) {
  if (record.head.outcome != "done" || isToolMeasured(record)) return std::nullopt;
  try {
    const ToolRecords tool(path);
    return measure("", tool.strokes(tool.own()), evenSections(tool.own().asked, kJudgedSections));
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// Writes a record's new verdict, if there is one.
void judgeAgain(const std::string& path, const Tolerances& tolerances) {
  Record record = readRecord(path);
  const std::optional<GroundTool> tool = toolOf(record, path);
  const auto judge = [&](Record& one) { return judgeAgain(one, tool ? &*tool : nullptr, tolerances); };
  // A record that stays as it is may be one that cannot be written.
  if (judge(record)) changeRecord(path, judge);
}

/// Reads a record. @param tolerances tolerances by which to judge it again; nothing to keep its verdict.
Read readOne(const Listed& record, const std::optional<Tolerances>& tolerances, const Filter& filter,
             const Listing& listing) {
  try {
    if (tolerances) judgeAgain(record.path, *tolerances);
    const RecordHead head = readHead(record.path);
    if (!filter.takesTool(head) || !filter.takesVerdict(head)) return {};
    return {listing.linesOf({record.path, *record.grinder, head}), ""};
  } catch (const std::exception& error) {
    const std::string reason = error.what();
    return {std::nullopt, reason.substr(0, reason.find('\n'))};
  }
}

/// Reads records on all cores, and forgets their paths. @param shown what a terminal says meanwhile; nothing if it is
/// quick. @param read reads a record. @param take takes each result, in order.
template <typename ReadOne, typename Take>
void readAll(std::vector<Listed> records, const std::string& shown, const ReadOne& read, const Take& take) {
  constexpr std::size_t block = 1024;  // bounds the memory
  std::vector<Read> done;
  for (std::size_t begin = 0; begin < records.size(); begin += block) {
    done.assign(std::min(block, records.size() - begin), {});
    std::optional<Working> working;
    if (!shown.empty()) working.emplace(shown);
    onAllCores(done.size(), [&](std::size_t i) {
      done[i] = read(records[begin + i]);
      records[begin + i].path = {};
    });
    working.reset();
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

std::string lastRecord(const std::string& node, const std::string& folder) {
  const std::string path = folder.empty() ? historyFolder(node) : folder;
  const std::vector<std::string> paths = pathsIn(path);
  if (paths.empty()) throw FileError(path + ": has no record of a job");
  return paths.back();
}

std::vector<ToolNumber> toolsOf(const std::string& node, const std::string& folder, const GrindJob& job) {
  const std::string path = folder.empty() ? historyFolder(node) : folder;
  try {
    return toolsIn(path, jobDigest(job));
  } catch (const std::filesystem::filesystem_error& error) {
    throw unreadable(path, error);
  }
}

std::string doneOperations(const std::string& node, const std::string& job) {
  GrindJob tool;
  try {
    tool = readJobFile(job, "1");
  } catch (const FileError&) {
    return "";
  }
  if (tool.operations.size() < 2) return "";
  std::vector<std::string> paths;
  try {
    paths = pathsIn(historyFolder(node));
  } catch (const std::runtime_error&) {
    // A grinder that has no folder yet has no records.
  }
  std::map<std::string, std::string> ended;
  for (const std::string& path : paths) {
    try {
      const RecordHead head = readHead(path);
      if (head.outcome == "done") ended[head.digest] = head.ended;
    } catch (const std::exception&) {
      // `grind history` names the unreadable record.
    }
  }
  std::string done;
  for (const GrindJob& operation : tool.ofAllOperations()) {
    const auto found = ended.find(jobDigest(operation));
    if (found == ended.end()) continue;
    done += (done.empty() ? "" : ", ") + std::string(toString(operation.process().kind)) + " (" +
            timeText(timeOf(found->second), false) + ")";
  }
  return "done by the records: " + (done.empty() ? "none" : done);
}

std::string tolerancesFile(const std::string& path) {
  return path.empty() ? packageFile("config/tolerances.yaml") : path;
}

int printHistory(const std::string& node, const HistoryOptions& options) {
  const Filter filter(options);
  const std::vector<Folder> folders = foldersOf(node, options);
  std::optional<Tolerances> tolerances;
  if (options.judge_again) tolerances = readTolerances(tolerancesFile(options.tolerances));
  Listing listing(options);
  std::vector<Listed> records;
  int status = findRecords(folders, records) ? 0 : 2;
  if (status != 0 && folders.size() == 1) return status;
  std::string none = records.empty() ? "no records in" : "no such records in";
  for (const Folder& folder : folders) none += (&folder == &folders.front() ? " " : ", ") + folder.path;
  const auto is_other = [&](const Listed& record) { return !filter.takes(record.path); };
  records.erase(std::remove_if(records.begin(), records.end(), is_other), records.end());
  // The CSV file must not overwrite a record.
  for (const Listed& record : records) {
    if (!options.csv.empty()) requireRegularFile(record.path);
  }
  const char* shown = tolerances ? "measuring and judging tools" : "";
  readAll(
      std::move(records), shown, [&](const Listed& record) { return readOne(record, tolerances, filter, listing); },
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
