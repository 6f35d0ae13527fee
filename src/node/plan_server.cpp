#include "node/plan_server.h"

#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/messages/reasons.h"

#include <future>
#include <limits>
#include <utility>

namespace grinder {

namespace {

constexpr unsigned kThreads = 2;  ///< one waits for its plan, the other answers "busy"

}  // namespace

PlanServer::PlanServer(const ros::NodeHandle& private_nh, const ControlLoop& loop, Planner& planner,
                       Telemetry& telemetry, const OffsetStore& offsets)
    : loop_(loop),
      planner_(planner),
      telemetry_(telemetry),
      offsets_(offsets),
      control_(std::make_shared<PlanControl>()),
      spinner_(kThreads, &queue_) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(&queue_);
  service_ = nh.advertiseService("plan", &PlanServer::onPlan, this);
  spinner_.start();
}

PlanServer::~PlanServer() {
  control_->give_up = true;
  spinner_.stop();
}

/// @return null if another job is being planned. @throw InvalidJob
std::shared_ptr<const PlannedJob> PlanServer::planOf(const flute_grinder::GrindGoal& goal, const Axes& offset) {
  std::promise<std::shared_ptr<const PlannedJob>> promise;
  Planner::Request request{ValidJob(jobFromGoal(goal))};
  request.run = {Eigen::Map<const Axes>(loop_.status().command.data()), {goal.first_tooth, goal.first_pass}, offset};
  request.control = control_;
  request.done = [&](std::shared_ptr<const PlannedJob> plan) { promise.set_value(std::move(plan)); };
  return planner_.submit(std::move(request)) ? promise.get_future().get() : nullptr;
}

bool PlanServer::onPlan(flute_grinder::Plan::Request& request, flute_grinder::Plan::Response& response) {
  response.valid = 0;
  const std::string unknown = offsets_.unknown();
  if (!unknown.empty()) {
    response.reasons.push_back(unknown);
    return true;
  }
  const WorkOffsets offsets = offsets_.offsets();
  std::shared_ptr<const PlannedJob> planned;
  try {
    planned = planOf(request.goal, offsets.values());
  } catch (const InvalidJob& invalid) {
    PlannedJob refused;
    refused.fault = PlanFault::kInvalidJob;
    refused.reasons = invalid.reasons();
    planned = std::make_shared<const PlannedJob>(std::move(refused));
  }
  if (!planned) {
    response.reasons.emplace_back("busy: another job is being planned; ask again when it is done");
    return true;
  }
  const PlannedJob& plan = *planned;
  response.valid = static_cast<std::uint8_t>(plan.good());
  response.statistics = toMessage(plan.statistics);
  response.duration = plan.statistics.duration;
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  const Range complete = plan.complete.value_or(Range{nowhere, nowhere});
  response.complete_from = complete.from;
  response.complete_to = complete.to;
  const CutterFigures& ground = plan.figures;
  response.rake = {ground.rake.from, ground.rake.to};
  response.chordal_rake = {ground.chordal_rake.from, ground.chordal_rake.to};
  response.spiral_angle = {ground.spiral.from, ground.spiral.to};
  response.edge = ground.edge;
  response.core_diameter = {ground.core_diameter[0], ground.core_diameter[1]};
  if (plan.closest) {
    response.closest_bodies = {plan.closest->first, plan.closest->second};
    response.closest_distance = plan.closest->distance;
    response.closest_x = plan.closest->axes[kX];
  }
  response.warnings = offsetWarnings(offsets, request.goal);
  response.violations = toMessage(plan.reasons);
  for (const Reason& reason : plan.reasons) response.reasons.push_back(text(reason));
  if (plan.good()) telemetry_.show(planned);
  return true;
}

}  // namespace grinder
