#pragma once

#include "flute_grinder/messages/json.h"
#include "flute_grinder/record/verdict.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// @file
/// The files in which a grinder keeps the records of its jobs: one folder for each grinder, one file for each job.
/// Their names begin with a running number, so that they sort in order of writing whatever the clock was set to. A
/// record is JSON in three lines: its head, which is all that a list of many records reads; its body; and a checksum of
/// both, which exposes a record that a crash has cut off or somebody has changed.
namespace grinder {

/// The head of a record, as shown in lists.
struct RecordHead {
  std::string grinder;         ///< name of the node
  std::string started, ended;  ///< texts of utcText()
  double duration = 0;         ///< duration of the run [s]
  std::string job;             ///< name of the job; may be empty
  std::string digest;          ///< digest, see jobDigest()
  std::string operation;       ///< text of GrindJob::operationText()
  std::string tool;            ///< text of toolText()
  bool continues = false;      ///< continues an earlier run of the same job
  bool ends_tool = false;      ///< whether the operation is the last of its tool, or the only one
  std::string wheel;           ///< name of the wheel; may be empty
  std::string dressed;         ///< time of the wheel's last dressing; empty if unknown
  double wear = 0;             ///< wear of the wheel's radius [mm]
  std::string outcome;         ///< "done", "canceled" or "fault"
  std::string reason;          ///< reason for the operator; empty for "done"
  std::uint64_t strokes = 0;   ///< strokes ground to their end
  std::uint64_t passes = 0;    ///< passes of the job, from the first to grind
  std::uint64_t holds = 0;
  std::uint64_t setpoints = 0;  ///< setpoints written to the drive
  std::uint64_t lost = 0;       ///< setpoints missing from the record
  std::string verdict;          ///< see Verdict::verdict
  std::vector<std::string> because;
};

Json toJson(const RecordHead& head);

struct Record {
  RecordHead head;
  Json body;  ///< body, see docs/ros-interface.md
};

/// The text of a record's file, with its checksum.
std::string text(const Record& record);

/// Reads only the head of a record. @param path a path from recordFilesIn(). @throw FileError if the file cannot be
/// read or has no valid head, naming the wrong key.
RecordHead readHead(const std::string& path);

/// Reads a record, with its texts escaped(). @throw FileError as readHead(), and if the checksum is wrong.
Record readRecord(const std::string& path);

/// Changes a record on the disk. One change is made after the other: none is lost if programs make them at once.
/// @param change is given the record as it is now. @return the record as changed. @throw FileError as readRecord(), and
/// if it cannot be written; the record is then as it was.
Record changeRecord(const std::string& path, const std::function<void(Record&)>& change);

/// Whether a file begins like a record. @throw FileError if it cannot be read or is not a regular file.
bool isRecord(const std::string& path);

/// Judges a record again by other tolerances, and by its tool.
/// @param tool null if not measured now: earlier measurements then remain.
/// @return whether any criterion changes.
bool judgeAgain(Record& record, const GroundTool* tool, const Tolerances& tolerances);

/// Whether the tool of a record was measured, as far as possible.
bool isToolMeasured(const Record& record);

/// A time as records write it, to the nearest millisecond, e.g. "2026-11-22T17:04:13.123Z". @param time since the epoch
/// [s].
std::string utcText(double time);

/// The time of a text of utcText(), since the epoch [s]. @throw std::invalid_argument naming any other text.
double timeOf(const std::string& utc);

/// A time as written in the names of records, e.g. "20261122T170413.123Z". @param time since the epoch [s].
std::string startText(double time);

/// The start of the job in a record's name, see startText(). @param record_name name with or without its folder.
std::string_view startOf(std::string_view record_name);

/// Whether a file has the name of a record.
bool isRecordName(std::string_view name);

/// Whether a file has the temporary name of a record being written; such a file remains after a power failure.
bool isUnfinishedRecordName(std::string_view name);

/// The paths in a folder that are named like records; each list ends with the one written last.
struct RecordFiles {
  std::vector<std::string> records;
  std::vector<std::string> unfinished;
  std::vector<std::string> others;  ///< files with such a name that are not regular: folders, links, FIFOs
};

/// @throw std::filesystem::filesystem_error if the folder cannot be read.
RecordFiles recordFilesIn(const std::string& folder);

/// The name of a record to be written, e.g. "0000000042_20261122T170413.123Z.json".
/// @param start start of the job since the epoch [s]. @param before files in the folder: the name sorts after them all.
/// @throw std::runtime_error if the highest number is in use.
std::string recordName(double start, const RecordFiles& before);

}  // namespace grinder
