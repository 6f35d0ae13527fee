#include "node/progress_tracker.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/messages/conversions.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

/// Difference within which work offsets count as equal: the rounding of a display [m], A [rad].
constexpr double kSameOffset = 1e-7, kSameAngle = 1e-6;
constexpr int kOffsetDigits = 9;            ///< digits with which offsets that differ look different
const ros::WallDuration kPlaceInterval(1);  ///< time between entries within a stroke

/// A place as text for the operator; teeth and passes count from 1.
std::string placeText(const ToothPass& place) { return format("tooth %d, pass %d", place.tooth + 1, place.pass + 1); }

std::string describe(const Progress& p) {
  return jobText(p.job_name, p.operation, p.cutter, p.tooth_angles.size()) + ", " + placeText(p.next);
}

bool isUnfinished(const Progress& p) { return !p.job_digest.empty() && !p.finished; }

}  // namespace

ProgressTracker::ProgressTracker(Journal& journal) : journal_(journal), progress_(journal.status().on_disk) {}

std::string ProgressTracker::refusal(const std::string& digest, const ToothPass& first) const {
  const Journal::Status journal = journal_.status();
  if (!journal.unread.empty()) return journal.error;
  if (first == ToothPass{} || (isUnfinished(progress_) && digest == progress_.job_digest && first == progress_.next)) {
    return "";
  }
  return "the job is to begin at " + placeText(first) +
         ", and the journal does not have the passes before as ground; allowed: " + placeText({}) +
         ", or where the journal has left the job";
}

std::optional<Need> ProgressTracker::need(const std::string& digest, const ToothPass& first) const {
  Need need{NeedKind::kUnfinishedJob, "", {}, {NeedAnswer::kDiscard}};
  const std::string damage = journal_.status().damage;
  if (!damage.empty()) {
    need.text = damage + "; what job it kept is unknown; restore the file, or discard it";
  } else if (isUnfinished(progress_) && !(digest == progress_.job_digest && first == progress_.next)) {
    need.text = "the journal keeps a job that is not finished: " + describe(progress_) + "; continue it, or discard it";
  } else {
    return std::nullopt;
  }
  return need;
}

std::optional<Need> ProgressTracker::offsetNeed(const std::string& digest, const ToothPass& first,
                                                const WorkOffsets& offsets) const {
  const std::string changed = progress_.finished || digest != progress_.job_digest ? "" : sinceItBegan(offsets);
  if (changed.empty()) return std::nullopt;
  Need need{NeedKind::kUnfinishedJob, "the job is not finished, and " + changed, {}, {}};
  if (first == ToothPass{}) need.answers.push_back(NeedAnswer::kDiscard);
  return need;
}

bool ProgressTracker::continues(const std::string& digest, const WorkOffsets& offsets) const {
  return !progress_.finished && digest == progress_.job_digest && sinceItBegan(offsets).empty();
}

/// What has changed since the unfinished job began, with the remedy; empty if nothing has.
std::string ProgressTracker::sinceItBegan(const WorkOffsets& offsets) const {
  if (offsets.wheel.mounting != progress_.mounting) {
    return "another wheel has been mounted since it began; discard the job";
  }
  if (offsets.tool.clamping != progress_.clamping) return "a tool was clamped since it began; discard the job";
  const std::string changes = offsetChanges(offsets);
  if (changes.empty()) return "";
  return "it began with other work offsets" + changes + "; set them as they were, or discard the job";
}

/// The changes of the offsets since the last entry, for the operator; empty if there are none.
std::string ProgressTracker::offsetChanges(const WorkOffsets& offsets) const {
  const Axes offset = offsets.values();
  std::string changes;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    if (std::abs(offset[axis] - progress_.offset[axis]) <= (axis == kA ? kSameAngle : kSameOffset)) continue;
    const auto shown = [&](double value) { return text(Quantity{value, unitOf(axis, 0)}, kOffsetDigits); };
    changes +=
        "; that of " + axisName(axis) + " was " + shown(progress_.offset[axis]) + " and is " + shown(offset[axis]);
  }
  return changes;
}

void ProgressTracker::begin(const GrindProgram& program, const std::string& digest, const OffsetBasis& job,
                            std::uint64_t number, const WorkOffsets& offsets) {
  before_ = progress_;
  number_ = number;
  moves_ = program.moves();
  passes_ = program.job().passes();
  strokes_ended_at_ = 0;
  running_ = true;
  progress_ = Progress();
  progress_.feed_override = before_.feed_override;
  progress_.job_digest = digest;
  progress_.job_name = job.job_name;
  progress_.operation = program.job()->operationText();
  progress_.cutter = program.job()->cutter;
  progress_.tooth_angles = program.job()->tooth_angles;
  progress_.next = program.run().first;
  progress_.x = program.strokeFrom();
  // The wheel counts as in the work until the job has ended: after a crash only the drive's positions can show that it
  // is clear.
  progress_.wheel = wheelOf(program);
  progress_.wheel.in_work = true;
  progress_.offset = program.run().offset;
  progress_.mounting = offsets.wheel.mounting;
  progress_.clamping = offsets.tool.clamping;
  progress_.tool_digest = job.tool_digest;
  progress_.kind = job.kind;
  write();
}

void ProgressTracker::revert() {
  running_ = false;
  progress_ = before_;
  write();
}

void ProgressTracker::end(const LoopStatus& status, const std::string& how) {
  updatePlace(status);
  running_ = false;
  progress_.end = how;
  progress_.wheel = status.wheel;
  write();
}

void ProgressTracker::update(const LoopStatus& status) {
  if (status.feed_override != progress_.feed_override) {
    progress_.feed_override = status.feed_override;
    changed_ = running_;
  }
  if (running_) updatePlace(status);
  // An unknown wheel must not overwrite the known one in the file.
  if (!status.wheel.known) return;
  const auto known = [](const Wheel& wheel) { return std::pair(wheel.in_work, wheel.y_doubted); };
  if (!running_ && known(progress_.wheel) != known(status.wheel)) {
    progress_.wheel = status.wheel;
    write();
  }
  // Retry an entry that failed: the disk may have room again, or an unreadable journal may have been removed.
  const Journal::Status journal = journal_.status();
  const bool failed = !journal.unread.empty() || (request_ > 0 && !journal.error.empty());
  const bool due = changed_ || (failed && journal.number >= request_);
  if (due && ros::SteadyTime::now() - last_entry_ >= kPlaceInterval) write();
}

void ProgressTracker::updatePlace(const LoopStatus& status) {
  if (progress_.finished || status.jobs_started != number_) return;
  if (status.strokes_ended_at > strokes_ended_at_) {
    strokes_ended_at_ = status.strokes_ended_at;
    const Move& ended = moves_[strokes_ended_at_ - 1];
    const auto has_ended = [&](const JobPass& pass) { return pass.place == ToothPass{ended.tooth, ended.pass}; };
    const auto next = std::find_if(passes_.begin(), passes_.end(), has_ended) + 1;
    progress_.x = ended.to[kX];
    progress_.finished = next == passes_.end();
    if (!progress_.finished) progress_.next = next->place;
    write();
  }
  const Place& place = status.place;
  if (place.move == MoveKind::kStroke && place.move_index >= strokes_ended_at_ && place.x != progress_.x) {
    progress_.x = place.x;
    changed_ = true;
  }
}

void ProgressTracker::write() {
  request_ = journal_.write(progress_);
  changed_ = false;
  last_entry_ = ros::SteadyTime::now();
}

}  // namespace grinder
