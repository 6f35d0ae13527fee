#include "flute_grinder/record/record_file.h"

#include "flute_grinder/job/file_error.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/job/regular_file.h"
#include "flute_grinder/job/yaml_text.h"
#include "record/record_shape.h"
#include "record/record_summary.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace grinder {

namespace {

// As hasForm() takes them.
constexpr std::string_view kTimeForm = "0000-00-00T00:00:00.000Z";
constexpr std::string_view kStartForm = "00000000T000000.000Z";
constexpr std::string_view kNameForm = "0000000000_00000000T000000.000Z.json";
constexpr std::string_view kUnfinishedForm = "0000000000_00000000T000000.000Z.json.new";  ///< see writeFile()
constexpr std::size_t kDigits = kNameForm.find('_');
constexpr std::uint64_t kMostRecords = 9999999999;  ///< of so many digits

/// Without the folder.
std::string_view nameIn(std::string_view path) { return path.substr(path.rfind('/') + 1); }

std::string textOf(const std::string& path) {
  requireRegularFile(path);
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::string text(file ? static_cast<std::size_t>(file.tellg()) : 0, '\0');
  if (!file.seekg(0).read(text.data(), static_cast<std::streamsize>(text.size()))) {
    throw FileError(path + ": cannot be read");
  }
  return text;
}

/// What the library says, without its own numbers.
std::string wordsOf(const std::exception& error) {
  const std::string words = error.what();
  const bool numbered = words.rfind("[json.exception", 0) == 0;
  return numbered ? words.substr(words.find("] ") + 2) : words;
}

/// As summaryOf(). What is JSON, but has something else where the scanner looks for an object or a list, is named by
/// its key.
Json namedSummaryOf(const std::string& text) {
  try {
    return summaryOf(text);
  } catch (const std::invalid_argument&) {
    Json whole = Json::accept(text) ? Json::parse(text) : Json();
    if (whole.is_object()) checkRecord(whole, false);
    throw;
  }
}

/// @throw FileError
Json recordIn(const std::string& path, bool summary) {
  try {
    const std::string text = textOf(path);
    Json record = summary ? namedSummaryOf(text) : Json::parse(text);
    if (!record.is_object() || record.value("record", Json()) != 1) {
      throw FileError(path + ": is no record of a job that this program knows; allowed: \"record\": 1");
    }
    checkRecord(record, summary);
    return record;
  } catch (const FileError&) {
    throw;
  } catch (const JobFileError&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(path + ": is no record of a job: " + wordsOf(error));
  }
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
  // timegm() takes the 31st of a short month for a day of the next.
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

Json readRecord(const std::string& path) { return recordIn(path, false); }

Json readRecordSummary(const std::string& path) { return recordIn(path, true); }

}  // namespace grinder
