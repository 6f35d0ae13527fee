#include "flute_grinder/record/job_record.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/record/cycle_figures.h"
#include "record/ground_strokes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
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
      digest_(plan.program->job().digest()),
      names_(std::move(names)),
      offsets_(offsets),
      offsets_said_right_(said_right),
      pass_(plan.program->run().first),
      strokes_(plan.program->job()),
      ground_(plan.program->job()) {
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
  addGround(setpoint, sample);
  pass_ = {setpoint.tooth, setpoint.pass};
  if (setpoint.move != MoveKind::kStroke) return;
  strokes_.add(setpoint, since(sample));
  Axes error;
  for (int axis = 0; axis < kAxisCount; ++axis) error[axis] = sample.followingError(axis);
  strokes_.addFollowingError(error);
}

void JobRecord::addGround(const Setpoint& setpoint, const CycleSample& sample) {
  if (!not_ground_.empty()) return;
  try {
    ground_.add(setpoint, sample.position - program_->run().offset);
  } catch (const std::invalid_argument& error) {
    not_ground_ = error.what();
  }
}

Json JobRecord::zeroPointsJson() const {
  const auto timeOrNull = [](double time) { return time > 0 ? Json(utcText(time)) : Json(nullptr); };
  Json json = Json::object();
  for (std::size_t i = 0; i < offsets_.axes.size(); ++i) {
    const WorkOffset& offset = offsets_.axes[i];
    json[std::string(1, "xyza"[i])] = {{"set_by", offset.wasSet() ? Json(offset.set_by) : Json(nullptr)},
                                       {"set_at", timeOrNull(offset.set_at)},
                                       {"found_at", timeOrNull(offset.found_at)},
                                       {"set_for", grinder::toJson(offset.basis)}};
  }
  json["said_right"] = offsets_said_right_;
  return json;
}

RecordHead JobRecord::head() const {
  const GrindJob& job = *program_->job();
  const std::vector<Move>& moves = program_->moves();
  const auto is_stroke = [](const Move& move) { return move.kind == MoveKind::kStroke; };
  const auto is_complete = [](const StrokeFigures& stroke) { return stroke.complete; };
  const auto count = [](const auto& list, const auto& counts) {
    return static_cast<std::uint64_t>(std::count_if(list.begin(), list.end(), counts));
  };
  RecordHead head;
  head.started = utcText(started_);
  head.ended = utcText(ended_);
  // The difference of the texts, which are in whole milliseconds.
  head.duration = std::round(1000 * (timeOf(head.ended) - timeOf(head.started))) / 1000;
  head.job = names_.job;
  head.digest = digest_;
  head.operation = job.operationText();
  head.tool = toolText(job.cutter, job.tooth_angles.size());
  head.continues = program_->run().first != ToothPass{};
  head.ends_tool = job.operation + 1 == static_cast<int>(job.operations.size());
  head.wheel = names_.wheel;
  head.dressed = names_.wheel_dressed;
  head.wear = job.process().wheel_wear / kMillimetre;
  head.outcome = conclusion_.outcome;
  head.reason = conclusion_.reason;
  head.strokes = count(strokes_.strokes(), is_complete);
  head.passes = count(moves, is_stroke);
  head.holds = events_.holds().size();
  head.setpoints = std::max(conclusion_.setpoints_written, setpoints_ + lost_);
  head.lost = lost_;
  return head;
}

std::vector<Criterion> JobRecord::judge(const Tolerances& tolerances) const {
  const ValidJob& job = program_->job();
  std::vector<Criterion> criteria = criteriaOfTool(job, nullptr, tolerances);
  const RunFacts facts{job, strokes_.strokes(), planned_.feed_limits, cycles_, late_, longest_};
  for (Criterion& criterion : criteriaOfRun(facts, tolerances)) criteria.push_back(std::move(criterion));
  return criteria;
}

Record JobRecord::record(const std::string& grinder, const MachineInfo& machine, const Tolerances& tolerances) const {
  RunStrokes ground = ground_;
  ground.finish();
  const std::vector<Criterion> criteria = judge(tolerances);
  RecordHead head = this->head();
  head.grinder = grinder;
  std::vector<std::string> unknown;
  if (offsets_said_right_) unknown.emplace_back(kNoOffsetCheck);
  Verdict verdict = verdictOn(criteria, head.outcome, lost_, std::move(unknown));
  head.verdict = std::move(verdict.verdict);
  head.because = std::move(verdict.because);
  const ToothPass& first = program_->run().first;
  Json body{{"machine", toJson(machine)},
            {"job_file", toJson(*program_->job())},
            {"first", {{"tooth", first.tooth + 1}, {"pass", first.pass + 1}}},
            {"work_offsets", toJson(program_->run().offset, "")},
            {"zero_points", zeroPointsJson()},
            {"planned", plannedJson(planned_)},
            {"late_cycles", {{"count", late_}, {"longest_ms", longest_ * 1e3}}},
            {"criteria", toJson(criteria)},
            {"strokes", strokes_.json()},
            {"holds", events_.holds()},
            {"overrides", events_.overrides()},
            {"omitted", events_.omitted()},
            {"ground", toJson(ground.strokes())},
            {"not_ground", not_ground_}};
  return {std::move(head), std::move(body)};
}

}  // namespace grinder
