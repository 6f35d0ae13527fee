#include "flute_grinder/record/job_record.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/record/cycle_figures.h"
#include "flute_grinder/record/record_file.h"

#include <algorithm>
#include <utility>

namespace grinder {

namespace {

using namespace units;

constexpr const char* kNoEnd = "the grinder's program ended before the job did";

}  // namespace

Json plannedJson(const PathStatistics& planned) {
  return {{"setpoints", planned.setpoints},
          {"duration_s", planned.duration},
          {"max_deviation_um", planned.max_deviation / kMicrometre},
          {"feed_limits", toJson(planned.feed_limits)}};
}

JobRecord::JobRecord(const PlannedJob& plan, JobNames names, const WorkOffsets& offsets, bool said_right)
    : program_(plan.program),
      planned_(plan.statistics),
      digest_(plan.digest),
      names_(std::move(names)),
      offsets_(offsets),
      offsets_said_right_(said_right),
      pass_(plan.program->run().first),
      strokes_(plan.program->job()) {
  conclusion_.reason = kNoEnd;
}

void JobRecord::addCycle(const CycleSample& sample) {
  if (cycles_++ == 0) started_ = sample.time;
  ended_ = sample.time;
  if (isLate(sample.period, program_->machine().period)) ++late_;
  updateMax(longest_, sample.period);
  const bool by_operator = sample.interlock == Interlock::kNone;
  events_.add(since(sample), rowOf(sample.state).holds_job, by_operator ? "" : toString(sample.interlock),
              sample.feed_override, pass_);
}

void JobRecord::addSetpoint(const Setpoint& setpoint, const CycleSample& sample) {
  ++setpoints_;
  pass_ = {setpoint.tooth, setpoint.pass};
  if (setpoint.move != MoveKind::kStroke) return;
  strokes_.add(setpoint, since(sample));
  Axes error;
  for (int axis = 0; axis < kAxisCount; ++axis) error[axis] = sample.followingError(axis);
  strokes_.addFollowingError(error);
}

Json JobRecord::jobJson() const {
  const GrindJob& job = *program_->job();
  return {{"name", names_.job}, {"digest", digest_}, {"file", grinder::toJson(job)}};
}

Json JobRecord::zeroPointsJson() const {
  Json json = Json::object();
  for (std::size_t i = 0; i < offsets_.axes.size(); ++i) {
    const WorkOffset& offset = offsets_.axes[i];
    json[std::string(1, "xyza"[i])] = {{"set_by", offset.wasSet() ? Json(offset.set_by) : Json(nullptr)},
                                       {"set_at", offset.wasSet() ? Json(utcText(offset.set_at)) : Json(nullptr)},
                                       {"set_for", grinder::toJson(offset.basis)}};
  }
  json["said_right"] = offsets_said_right_;
  return json;
}

Json JobRecord::strokesJson() const {
  Json list = strokes_.json(true);
  for (std::size_t i = 0; i < list.size(); ++i) list[i]["complete"] = strokes_.strokes()[i].complete;
  return list;
}

Json JobRecord::json(const std::string& grinder, const MachineInfo& machine) const {
  const std::uint64_t written = std::max(conclusion_.setpoints_written, setpoints_ + lost_);
  const ToothPass& first = program_->run().first;
  const std::vector<Move>& moves = program_->moves();
  const auto passes =
      std::count_if(moves.begin(), moves.end(), [](const Move& move) { return move.kind == MoveKind::kStroke; });
  Json record{{"record", 1},
              {"grinder", grinder},
              {"machine", toJson(machine)},
              {"job", jobJson()},
              {"started", utcText(started_)},
              {"ended", utcText(ended_)},
              {"outcome", conclusion_.outcome},
              {"reason", conclusion_.reason},
              {"wheel", {{"name", names_.wheel}, {"dressed", names_.wheel_dressed}}},
              {"first", {{"tooth", first.tooth + 1}, {"pass", first.pass + 1}}},
              {"passes", passes},
              {"work_offsets", grinder::toJson(program_->run().offset, "")},
              {"zero_points", zeroPointsJson()},
              {"planned", plannedJson(planned_)},
              {"setpoints", {{"written", written}, {"lost", lost_}}},
              {"late_cycles", {{"count", late_}, {"longest_ms", longest_ * 1e3}}},
              {"strokes", strokesJson()},
              {"holds", events_.holds()},
              {"overrides", events_.overrides()}};
  if (events_.omitted() > 0) record["omitted"] = events_.omitted();
  return record;
}

}  // namespace grinder
