#include "flute_grinder/record/record_file.h"

#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/replace_file.h"
#include "flute_grinder/job/sha256.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <type_traits>

namespace grinder {

namespace {

// Forms for hasForm().
constexpr std::string_view kTimeForm = "0000-00-00T00:00:00.000Z";
constexpr std::string_view kStartForm = "00000000T000000.000Z";
constexpr std::string_view kNameForm = "0000000000_00000000T000000.000Z.json";
constexpr std::string_view kUnfinishedForm = "0000000000_00000000T000000.000Z.json.new";  ///< see writeFile()
constexpr std::size_t kDigits = kNameForm.find('_');
constexpr std::uint64_t kMostRecords = 9999999999;  ///< highest number with kDigits digits

/// A file's name without its folder.
std::string_view nameIn(std::string_view path) { return path.substr(path.rfind('/') + 1); }

// The lines of a file. Together they are one JSON object; the head needs the first line only.
constexpr std::string_view kHead = R"({"record":2,"head":)";
constexpr std::string_view kBody = R"("body":)";
constexpr std::string_view kSeal = R"("seal":")";
constexpr std::string_view kEnd = "\"}\n";

/// Calls `visit(key, member)` for each field, in the order of files and lists.
template <typename AnyHead, typename Visit>
void visitHead(AnyHead& head, const Visit& visit) {
  visit("grinder", head.grinder);
  visit("started", head.started);
  visit("ended", head.ended);
  visit("job", head.job);
  visit("digest", head.digest);
  visit("operation", head.operation);
  visit("tool", head.tool);
  visit("continues", head.continues);
  visit("ends_tool", head.ends_tool);
  visit("wheel", head.wheel);
  visit("dressed", head.dressed);
  visit("wear_mm", head.wear);
  visit("outcome", head.outcome);
  visit("reason", head.reason);
  visit("strokes", head.strokes);
  visit("passes", head.passes);
  visit("duration_s", head.duration);
  visit("holds", head.holds);
  visit("setpoints", head.setpoints);
  visit("lost", head.lost);
  visit("verdict", head.verdict);
  visit("verdict_because", head.because);
}

/// @throw FileError
std::ifstream opened(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path + ": cannot be read: " + std::strerror(errno));
  return file;
}

/// The message of the JSON library, without its error numbers.
std::string wordsOf(const std::exception& error) {
  const std::string words = error.what();
  const bool numbered = words.rfind("[json.exception", 0) == 0;
  return numbered ? words.substr(words.find("] ") + 2) : words;
}

/// Carries out an action on a file's text. @throw FileError naming the file.
template <typename Action>
auto ofRecord(const std::string& path, const Action& action) {
  try {
    return action();
  } catch (const std::exception& error) {
    throw FileError(path + ": is no record of a job: " + wordsOf(error));
  }
}

/// Parses the head. @param line first line with the comma at its end, without the line feed.
RecordHead headIn(const std::string& line) {
  if (line.compare(0, kHead.size(), kHead) != 0)
    throw std::invalid_argument("it begins otherwise than " + std::string(kHead));
  if (line.back() != ',') throw std::invalid_argument("it is cut off");
  const Json json = Json::parse(line.begin() + kHead.size(), line.end() - 1);
  RecordHead head;
  visitHead(head, [&](const char* key, auto& value) {
    const auto found = json.find(key);
    if (found == json.end()) throw std::invalid_argument(std::string(key) + " is missing");
    try {
      found->get_to(value);
    } catch (const Json::exception&) {
      throw std::invalid_argument(std::string(key) + " = " + text(*found, -1) + ", which is of another type");
    }
    if constexpr (std::is_same_v<decltype(value), std::string&>) value = escaped(value);
  });
  for (std::string& reason : head.because) reason = escaped(reason);
  return head;
}

std::string sealOf(const std::string& text) { return sha256Hex(text.data(), text.size()); }

/// The part of a text before its checksum. @throw std::invalid_argument if it is damaged.
std::string unsealed(const std::string& text) {
  const std::size_t at = text.rfind('\n', text.empty() ? 0 : text.size() - 2);
  if (at == std::string::npos) throw std::invalid_argument("it is cut off");
  std::string sealed = text.substr(0, at + 1);
  if (text.substr(at + 1) != std::string(kSeal) + sealOf(sealed) + std::string(kEnd)) {
    throw std::invalid_argument("its seal is not that of its text: it is cut off, or was changed");
  }
  return sealed;
}

}  // namespace

std::string utcText(double time) {
  const auto milliseconds = std::llround(time * 1000);
  const auto seconds = static_cast<std::time_t>(milliseconds / 1000);
  std::tm t{};
  gmtime_r(&seconds, &t);
  return format("%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday, t.tm_hour, t.tm_min,
                t.tm_sec, static_cast<int>(milliseconds % 1000));
}

double timeOf(const std::string& utc) {
  if (!hasForm(utc, kTimeForm)) {
    throw std::invalid_argument("time = " + utc + "; allowed: YYYY-MM-DDThh:mm:ss.mmmZ");
  }
  const auto number = [&](std::size_t at, std::size_t digits) { return std::stoi(utc.substr(at, digits)); };
  std::tm t{};
  t.tm_year = number(0, 4) - 1900;
  t.tm_mon = number(5, 2) - 1;
  t.tm_mday = number(8, 2);
  t.tm_hour = number(11, 2);
  t.tm_min = number(14, 2);
  t.tm_sec = number(17, 2);
  const double time = static_cast<double>(timegm(&t)) + number(20, 3) / 1000.0;
  // timegm() accepts the 31st of a short month as a day of the next month.
  if (utcText(time) != utc) throw std::invalid_argument("time = " + utc + "; allowed: a time that there is");
  return time;
}

std::string startText(double time) {
  std::string text = utcText(time);
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '-' || c == ':'; }), text.end());
  return text;
}

std::string_view startOf(std::string_view record_name) {
  return nameIn(record_name).substr(kDigits + 1, kStartForm.size());
}

bool isRecordName(std::string_view name) { return hasForm(name, kNameForm); }

bool isUnfinishedRecordName(std::string_view name) { return hasForm(name, kUnfinishedForm); }

RecordFiles recordFilesIn(const std::string& folder) {
  RecordFiles files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool finished = isRecordName(name);
    if (!finished && !isUnfinishedRecordName(name)) continue;
    std::vector<std::string>& list = !std::filesystem::is_regular_file(entry.symlink_status()) ? files.others
                                     : finished                                                ? files.records
                                                                                               : files.unfinished;
    list.push_back(entry.path().string());
  }
  for (auto* list : {&files.records, &files.unfinished, &files.others}) std::sort(list->begin(), list->end());
  return files;
}

std::string recordName(double start, const RecordFiles& before) {
  std::uint64_t number = 0;
  for (const auto* list : {&before.records, &before.unfinished, &before.others}) {
    if (list->empty()) continue;
    const std::string_view name = nameIn(list->back());
    number = std::max<std::uint64_t>(number, std::stoull(std::string(name.substr(0, kDigits))));
    if (number == kMostRecords) throw std::runtime_error(list->back() + ": has the greatest number; move it elsewhere");
  }
  return format("%0*llu_", static_cast<int>(kDigits), static_cast<unsigned long long>(number + 1)) + startText(start) +
         ".json";
}

bool isRecord(const std::string& path) {
  requireRegularFile(path);
  std::string begin(kHead.size(), '\0');
  opened(path).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kHead;
}

bool isToolMeasured(const Record& record) {
  const std::vector<Criterion> criteria = criteriaFrom(record.body.at("criteria"));
  return std::any_of(criteria.begin(), criteria.end(),
                     [](const Criterion& c) { return c.of_tool && (c.measured || c.missing); });
}

bool judgeAgain(Record& record, const GroundTool* tool, const Tolerances& tolerances) {
  Json& judged = record.body.at("criteria");
  const Json before = judged;
  std::vector<Criterion> criteria = criteriaFrom(judged);
  if (tool != nullptr) {
    criteria.erase(std::remove_if(criteria.begin(), criteria.end(), [](const Criterion& c) { return c.of_tool; }),
                   criteria.end());
    std::vector<Criterion> of_tool = criteriaOfTool(tool->job, tool, tolerances);
    criteria.insert(criteria.begin(), of_tool.begin(), of_tool.end());
  }
  judgeAgain(criteria, tolerances);
  judged = toJson(criteria);
  std::vector<std::string> unknown;
  if (record.body.at("zero_points").at("said_right").get<bool>()) unknown.emplace_back(kNoOffsetCheck);
  const Verdict verdict = verdictOn(criteria, record.head.outcome, record.head.lost, std::move(unknown));
  record.head.verdict = verdict.verdict;
  record.head.because = verdict.because;
  return judged != before;
}

Json toJson(const RecordHead& head) {
  Json json = Json::object();
  visitHead(head, [&](const char* key, const auto& value) { json[key] = value; });
  return json;
}

std::string text(const Record& record) {
  std::string lines = std::string(kHead) + text(toJson(record.head), -1) + ",\n";
  lines += std::string(kBody) + text(record.body, -1) + ",\n";
  return lines + std::string(kSeal) + sealOf(lines) + std::string(kEnd);
}

RecordHead readHead(const std::string& path) {
  std::ifstream file = opened(path);
  return ofRecord(path, [&] {
    std::string line;
    std::getline(file, line);
    if (file.eof()) throw std::invalid_argument("it is cut off");
    return headIn(line);
  });
}

Record changeRecord(const std::string& path, const std::function<void(Record&)>& change) {
  const FileLock lock(path);
  Record record = readRecord(path);
  change(record);
  try {
    replaceFile(path, text(record));
  } catch (const std::system_error& error) {
    throw FileError(path + ": cannot be changed: " + error.code().message());
  }
  return record;
}

Record readRecord(const std::string& path) {
  requireRegularFile(path);
  std::ifstream file = opened(path);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  return ofRecord(path, [&] {
    const std::string sealed = unsealed(whole);
    const std::size_t body = sealed.find('\n') + 1;
    Record record{headIn(sealed.substr(0, body - 1)),
                  Json::parse(sealed.begin() + static_cast<std::ptrdiff_t>(body + kBody.size()), sealed.end() - 2)};
    escapeTexts(record.body);
    return record;
  });
}

}  // namespace grinder
