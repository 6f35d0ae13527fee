#pragma once

#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/verdict.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// The files in which a grinder keeps the records of its jobs: one folder for each grinder, one file for each job.
/// Their names begin with a number that counts them, and sort by it whatever the clock was set to. A record is JSON in
/// three lines: its head, which is all that a list of many records reads; its body; and a seal of both, so that what a
/// crash has cut off, or somebody has changed, is no record.
namespace grinder {

/// What a list of records has of one.
struct RecordHead {
  std::string grinder;         ///< the node's name
  std::string started, ended;  ///< as utcText()
  double duration = 0;         ///< [s]
  std::string job;             ///< its name; may be empty
  std::string digest;          ///< see jobDigest()
  std::string operation;       ///< as GrindJob::operationText()
  std::string tool;            ///< as toolText()
  bool continues = false;      ///< an earlier run of the same job
  bool ends_tool = false;      ///< whether the operation is the last of its tool, or the only one
  std::string wheel;           ///< its name; may be empty
  std::string dressed;         ///< when the wheel was; empty if that is not known
  double wear = 0;             ///< of the wheel's radius [mm]
  std::string outcome;         ///< "done", "canceled" or "fault"
  std::string reason;          ///< for the operator; empty for "done"
  std::uint64_t strokes = 0;   ///< ground to their end
  std::uint64_t passes = 0;    ///< of the job, from the first to grind on
  std::uint64_t holds = 0;
  std::uint64_t setpoints = 0;  ///< written to the drive
  std::uint64_t lost = 0;       ///< setpoints that are not in the record
  std::string verdict;          ///< as Verdict has it
  std::vector<std::string> because;
};

Json toJson(const RecordHead& head);

struct Record {
  RecordHead head;
  Json body;  ///< see docs/ros-interface.md
};

/// As the file has it, sealed.
std::string text(const Record& record);

/// Reads the first line only. @param path of recordFilesIn(). @throw FileError if the file cannot be read, or has no
/// head; with the key that is wrong.
RecordHead readHead(const std::string& path);

/// With its texts escaped(). @throw FileError as readHead(), and if the seal is not that of the file.
Record readRecord(const std::string& path);

/// Whether a file begins like a record. @throw FileError if it cannot be read, JobFileError if it is no regular file.
bool isRecord(const std::string& path);

/// Judges a record again by other tolerances, and by its tool.
/// @param tool null if it was not measured now: what was measured before remains.
/// @return whether that changes any criterion.
bool judgeAgain(Record& record, const GroundTool* tool, const Tolerances& tolerances);

/// Whether the tool of a record was measured, as far as that can be.
bool isToolMeasured(const Record& record);

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

}  // namespace grinder
