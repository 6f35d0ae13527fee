#include "flute_grinder/node/bookkeeper.h"

#include "flute_grinder/messages/conversions.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace flute_grinder {

namespace {

const ros::WallDuration kPlaceInterval(1);  ///< between entries within a stroke

/// A job for people, who count teeth and passes from 1.
std::string describe(const Progress& p) {
  std::ostringstream text;
  text << (p.job_name.empty() ? "a job without a name" : p.job_name) << " ("
       << toolText(p.cutter, p.tooth_angles.size()) << "), tooth " << p.next.tooth + 1 << ", pass " << p.next.pass + 1;
  return text.str();
}

bool same(const ToothPass& a, const ToothPass& b) { return a.tooth == b.tooth && a.pass == b.pass; }

}  // namespace

Bookkeeper::Bookkeeper(JournalKeeper& keeper) : keeper_(keeper), progress_(keeper.told().on_disk) {}

std::string Bookkeeper::objection(const std::string& digest, const ToothPass& first) const {
  if (progress_.job_digest.empty() || progress_.finished) return "";
  const bool from_the_beginning = first.tooth == 0 && first.pass == 0;
  if (digest == progress_.job_digest && (!from_the_beginning || same(first, progress_.next))) return "";
  return "the journal keeps a job that is not finished: " + describe(progress_) + "; continue it, or discard it";
}

void Bookkeeper::begin(const GrindProgram& program, const std::string& digest, const std::string& name,
                       const ToothPass& first, std::uint64_t number) {
  before_ = progress_;
  number_ = number;
  moves_ = program.moves();
  passes_ = passOrder(program.job());
  strokes_ended_at_ = 0;
  running_ = true;
  progress_ = Progress();
  progress_.job_digest = digest;
  progress_.job_name = name;
  progress_.cutter = program.job().cutter;
  progress_.tooth_angles = program.job().tooth_angles;
  progress_.next = first;
  progress_.x = program.strokeFrom();
  // Until the job has ended: after a crash only the drive's positions could tell that the wheel was out of the work.
  progress_.wheel = wheelOf(program);
  progress_.wheel.in_work = true;
  write();
}

void Bookkeeper::revert() {
  running_ = false;
  progress_ = before_;
  write();
}

void Bookkeeper::end(const LoopStatus& status) {
  takePlace(status);
  running_ = false;
  progress_.wheel = status.wheel;
  write();
}

void Bookkeeper::follow(const LoopStatus& status) {
  if (running_) takePlace(status);
  if (!running_ && progress_.wheel.in_work != status.wheel.in_work) {
    progress_.wheel = status.wheel;
    write();
  }
  // An entry that has failed is made once more: the disk may have room again.
  const bool due = place_changed_ || (order_ > 0 && settled() && !error().empty());
  if (due && ros::SteadyTime::now() - last_entry_ >= kPlaceInterval) write();
}

void Bookkeeper::takePlace(const LoopStatus& status) {
  if (progress_.finished || status.jobs_started != number_) return;
  if (status.strokes_ended_at > strokes_ended_at_) {
    strokes_ended_at_ = status.strokes_ended_at;
    const Move& ended = moves_[strokes_ended_at_ - 1];
    const auto is_ended = [&](const ToothPass& pass) { return same(pass, {ended.tooth, ended.pass}); };
    const auto next = std::find_if(passes_.begin(), passes_.end(), is_ended) + 1;
    progress_.x = ended.to[kX];
    progress_.finished = next == passes_.end();
    if (!progress_.finished) progress_.next = *next;
    write();
  }
  const Place& place = status.place;
  if (place.move == MoveKind::kStroke && place.move_index >= strokes_ended_at_ && place.x != progress_.x) {
    progress_.x = place.x;
    place_changed_ = true;
  }
}

void Bookkeeper::write() {
  order_ = keeper_.write(progress_);
  place_changed_ = false;
  last_entry_ = ros::SteadyTime::now();
}

}  // namespace flute_grinder
