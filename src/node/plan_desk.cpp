#include "flute_grinder/node/plan_desk.h"

#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/reasons.h"

#include <future>
#include <utility>

namespace flute_grinder {

namespace {

constexpr unsigned kThreads = 2;  ///< one waits for its plan, one says that the planner is busy

}  // namespace

PlanDesk::PlanDesk(const ros::NodeHandle& private_nh, const ControlLoop& loop, Planner& planner, Teller& teller)
    : loop_(loop),
      planner_(planner),
      teller_(teller),
      control_(std::make_shared<PlanControl>()),
      spinner_(kThreads, &queue_) {
  ros::NodeHandle nh(private_nh);
  nh.setCallbackQueue(&queue_);
  service_ = nh.advertiseService("plan", &PlanDesk::onPlan, this);
  spinner_.start();
}

PlanDesk::~PlanDesk() {
  control_->give_up = true;
  spinner_.stop();
}

bool PlanDesk::onPlan(Plan::Request& request, Plan::Response& response) {
  std::promise<std::unique_ptr<Preview>> promise;
  auto answer = promise.get_future();
  Planner::Order order;
  order.job = jobFromGoal(request.goal);
  order.start = Eigen::Map<const Axes>(loop_.status().command.data());
  order.first = {request.goal.first_tooth, request.goal.first_pass};
  order.control = control_;
  order.done = [&](std::unique_ptr<Preview> preview) { promise.set_value(std::move(preview)); };
  const bool taken = planner_.submit(std::move(order));
  response.valid = 0;
  if (!taken) {
    response.reasons.emplace_back("busy: another job is being planned; ask again when it is done");
    return true;
  }
  const std::shared_ptr<Preview> preview = answer.get();
  const JobPlan& plan = preview->plan;
  response.valid = static_cast<std::uint8_t>(plan.good());
  response.statistics = toMessage(plan.statistics);
  response.duration = plan.statistics.duration;
  response.violations = toMessage(plan.reasons);
  for (const core::Reason& reason : plan.reasons) response.reasons.push_back(text(reason, UnitSystem::kSi));
  if (plan.good()) teller_.show(preview);
  return true;
}

}  // namespace flute_grinder
