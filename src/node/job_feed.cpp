#include "node/job_feed.h"

#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/messages/conversions.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

double fraction(double done, double all) { return all == 0 ? 0 : std::clamp(done / all, 0.0, 1.0); }

/// How far a job has come, in cycles of its plan.
double plannedCycles(const Setpoint& p, const std::vector<std::uint64_t>& move_ends) {
  const auto begin = static_cast<double>(p.move_index == 0 ? 0 : move_ends[p.move_index - 1]);
  return begin + p.move_fraction * (static_cast<double>(move_ends[p.move_index]) - begin);
}

/// X reached in the stroke that the axes make, or from which the wheel was lifted [m].
double strokeX(const Setpoint& p, const GrindProgram& program) {
  if (p.move == MoveKind::kStroke) return p.position[kX];
  const FeedSchedule& schedule = program.schedule(p.tooth);
  return schedule.x(p.move_fraction * schedule.length());
}

double strokeFraction(const Setpoint& p, const GrindProgram& program) {
  const MoveKind move = program.moves()[p.move_index].kind;
  if (move != MoveKind::kStroke) return phaseOf(move) == PassPhase::kAfter ? 1 : 0;
  if (program.isStraight()) return std::clamp(p.move_fraction, 0.0, 1.0);
  return fraction(strokeX(p, program) - program.strokeFrom(), program.strokeTo() - program.strokeFrom());
}

}  // namespace

JobFeed::JobFeed(const ros::NodeHandle& private_nh, double period, const MachineInfo& machine,
                 const Tolerances& tolerances, History& history, const FirstView& first_view, Frames& frames,
                 std::function<void()> on_end)
    : scene_(private_nh, first_view),
      recorder_(private_nh.getNamespace(), machine, tolerances, history),
      frames_(frames),
      on_end_(std::move(on_end)) {
  batch_.period = period;
}

void JobFeed::advertise(ros::NodeHandle& own, RecorderWatch& watch) {
  setpoints_ = own.advertise<flute_grinder::SetpointBatch>(
      "setpoints", 1000, [&watch](const auto& peer) { watch.connect(peer.getSubscriberName()); },
      [&watch](const auto& peer) { watch.disconnect(peer.getSubscriberName()); });
}

void JobFeed::announce(std::uint64_t number, const std::string& goal_id, const std::string& job_name,
                       std::shared_ptr<const PlannedJob> plan, std::shared_ptr<JobRecord> record) {
  jobs_.push_back({number, goal_id, job_name, std::move(plan)});
  recorder_.announce(number, std::move(record));
}

void JobFeed::withdraw(std::uint64_t number) {
  if (jobs_.empty() || jobs_.back().number != number) return;
  jobs_.pop_back();
  recorder_.withdraw(number);
}

void JobFeed::add(const CycleSample& sample, std::uint64_t cycle) {
  // If the sample of a job's end was lost, a sample of a later job ends that job.
  while (jobs_.size() > 1 && sample.job > jobs_.front().number) end(jobs_.front(), sample);
  if (!jobs_.empty() && sample.job == jobs_.front().number) track(jobs_.front(), sample, cycle);
}

void JobFeed::track(Job& job, const CycleSample& sample, std::uint64_t cycle) {
  JobRecord& job_record = recorder_.of(job.number);
  job_record.addCycle(sample);
  if (sample.has_setpoint) job.buffered.push_back({cycle, sample.period, sample.setpoint});
  // A drive may buffer commands: publish a setpoint with the positions of the cycle before it reaches the axes.
  auto& buffered = job.buffered;
  while (!buffered.empty() && buffered.front().cycle + sample.drive.commands_waiting <= cycle) {
    job.last = buffered.front().setpoint;
    if (job.shown) scene_.add(job.last, job.workPosition(sample));
    job_record.addSetpoint(job.last, sample);
    addToBatch(job, buffered.front(), sample);
    buffered.pop_front();
  }
  if (sample.job_ended) end(job, sample);
}

void JobFeed::addToBatch(Job& job, const Buffered& written, const CycleSample& sample) {
  const Setpoint& setpoint = written.setpoint;
  const std::uint64_t lost = setpoint.cycle - job.next_cycle;
  job.next_cycle = setpoint.cycle + 1;
  recorder_.of(job.number).addLost(lost);
  if (lost > 0) publishBatch();
  if (batch_.setpoints.empty()) {
    batch_.header.stamp = ros::Time(sample.time);
    batch_.goal_id = job.goal_id;
    batch_.lost = lost;
  }
  batch_.setpoints.push_back(toMessage(setpoint, job.workPosition(sample), written.period));
  batch_.end_stamp = ros::Time(sample.time);
  job.max_error = std::max(job.max_error, std::abs(setpoint.path_error));
}

void JobFeed::end(Job& job, const CycleSample& sample) {
  // Setpoints that were written but never reached the axes.
  for (const Buffered& unplayed : job.buffered) addToBatch(job, unplayed, sample);
  publishBatch();
  makeFeedback(sample);
  if (job.shown) scene_.end();
  const std::uint64_t number = job.number;
  recorder_.end(number);
  jobs_.pop_front();
  on_end_();
  published_ = number;
}

void JobFeed::publishBatch() {
  if (batch_.setpoints.empty()) return;
  setpoints_.publish(batch_);
  batch_.setpoints.clear();
}

void JobFeed::makeFeedback(const CycleSample& sample) {
  if (jobs_.empty()) return;
  Job& job = jobs_.front();
  const Setpoint& p = job.last;
  const PlannedJob& plan = *job.plan;
  const double done = plannedCycles(p, plan.move_ends);
  const auto all = static_cast<double>(plan.move_ends.back());
  flute_grinder::GrindFeedback feedback;
  feedback.state = toString(sample.state);
  feedback.planned = 1;
  feedback.tooth = p.tooth;
  feedback.pass = p.pass;
  feedback.x = p.position[kX];
  feedback.stroke_fraction = strokeFraction(p, *plan.program);
  feedback.job_fraction = fraction(done, all);
  feedback.remaining_time = std::max(0.0, all - done) * batch_.period;
  feedback.feed = p.feed;
  feedback.path_error = job.max_error;
  job.max_error = 0;
  const std::lock_guard<std::mutex> lock(feedback_mutex_);
  if (feedback_ && feedback_number_ == job.number) {
    feedback.path_error = std::max(feedback.path_error, feedback_->path_error);
  }
  feedback_number_ = job.number;
  feedback_ = std::move(feedback);
}

std::optional<flute_grinder::GrindFeedback> JobFeed::takeFeedback(std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(feedback_mutex_);
  if (feedback_number_ != number) return std::nullopt;
  return std::exchange(feedback_, std::nullopt);
}

bool JobFeed::showPlan(const PlannedJob& plan, const std::string& job_name, const WorkOffsets& offsets) {
  // While a job runs, that job is shown.
  if (!jobs_.empty() || scene_cleared_) return false;
  show(plan, job_name, "Planned: ");
  shown_with_ = offsets;
  return true;
}

void JobFeed::showRunning() {
  if (jobs_.empty() || jobs_.front().shown || scene_cleared_) return;
  show(*jobs_.front().plan, jobs_.front().name, "Ground: ");
  jobs_.front().shown = true;
}

/// @param how what it is in the legend.
void JobFeed::show(const PlannedJob& plan, const std::string& name, const char* how) {
  const GrindJob& job = *plan.program->job();
  const std::string operation = job.operationText();
  shown_with_.reset();
  frames_.show(plan.program, plan.edges);
  scene_.show(plan.program, plan.edges, plan.program->job().digest(), plan.program->run().first,
              how + jobText(name, operation, job.cutter, job.tooth_angles.size()));
}

void JobFeed::discardStalePlan(const WorkOffsets& offsets) {
  if (!shown_with_ || !jobs_.empty()) return;
  const Axes now = offsets.values(), then = shown_with_->values();
  if ((now == then).all() && offsets.wheel.mounting == shown_with_->wheel.mounting) return;
  shown_with_.reset();
  scene_.discard();
}

void JobFeed::updateScene() {
  if (scene_cleared_) return;
  scene_.greet();
  if (!jobs_.empty() && jobs_.front().shown) scene_.update();
}

void JobFeed::clearScene() {
  scene_cleared_ = true;
  for (Job& job : jobs_) job.shown = false;
  shown_with_.reset();
  scene_.clear();
}

}  // namespace grinder
