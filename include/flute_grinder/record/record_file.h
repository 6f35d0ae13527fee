#pragma once

#include "flute_grinder/messages/json.h"

#include <string>
#include <string_view>
#include <vector>

/// @file
/// The files in which a grinder keeps the records of its jobs: one folder for each grinder, one file for each job.
/// Their names begin with a number that counts them, and sort by it whatever the clock was set to.
namespace grinder {

/// A time as records write it, to the nearest millisecond, e.g. "2026-11-22T17:04:13.123Z". @param time since the epoch
/// [s].
std::string utcText(double time);

/// The time in such a text, since the epoch [s]. @throw std::invalid_argument naming any other text.
double timeOf(const std::string& utc);

/// A time as the names of records have it, e.g. "20261122T170413.123Z". @param time since the epoch [s].
std::string startText(double time);

/// The start of the job, as by startText(). @param record_name with or without its folder.
std::string_view startOf(std::string_view record_name);

/// Whether a file has the name of a record.
bool isRecordName(std::string_view name);

/// Whether it has the name under which a record is written before it gets its own; one stays if the power fails.
bool isUnfinishedRecordName(std::string_view name);

/// The paths in a folder that are named like records, each list with the one written last at its end.
struct RecordFiles {
  std::vector<std::string> records;
  std::vector<std::string> unfinished;
  std::vector<std::string> others;  ///< named like one of these, but no regular files: folders, links, FIFOs
};

/// @throw std::filesystem::filesystem_error if the folder cannot be read.
RecordFiles recordFilesIn(const std::string& folder);

/// The name of a record to be written, e.g. "0000000042_20261122T170413.123Z.json".
/// @param start of the job, since the epoch [s]. @param before what its folder has: the name sorts after all of it.
/// @throw std::runtime_error if there is no greater number.
std::string recordName(double start, const RecordFiles& before);

/// The record in a file, with its texts escaped(). @throw FileError if it cannot be read, is no record, or lacks a part
/// or has one of another type; with the key, its value and what is allowed.
Json readRecord(const std::string& path);

/// What a list of many records needs of one, and verdictOnRecord() for the same verdict, several times as fast. It is
/// as by readRecord(), but:
/// - "strokes" has no or one stroke, with the worst figure of all; "complete_strokes" is how many are ground to their
///   end;
/// - "holds" is their number;
/// - "operations" of the job's file, "zero_points", "work_offsets" and "overrides" are null.
/// @throw FileError as by readRecord(), except for a fault of syntax in what is left out.
Json readRecordSummary(const std::string& path);

}  // namespace grinder
