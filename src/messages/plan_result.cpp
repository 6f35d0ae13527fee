#include "flute_grinder/messages/plan_result.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/reasons.h"

#include <cmath>
#include <limits>

namespace grinder {

namespace {

using units::kMillimetre;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

flute_grinder::ToolFigure toMessage(const GroundFigure& figure) {
  flute_grinder::ToolFigure m;
  const Range asked = figure.asked.value_or(Range{kNone, kNone});
  m.figure = static_cast<std::uint8_t>(figure.figure);
  m.ground = {figure.least.value, figure.largest.value};
  m.x = {figure.least.x, figure.largest.x};
  m.tooth = {static_cast<std::uint16_t>(figure.least.tooth), static_cast<std::uint16_t>(figure.largest.tooth)};
  m.asked = {asked.from, asked.to};
  m.tolerance = figure.tolerance;
  return m;
}

flute_grinder::PassRemoval toMessage(const PassRemoval& pass) {
  flute_grinder::PassRemoval m;
  m.depth = pass.depth;
  m.area = pass.area;
  m.rate = pass.rate;
  m.volume = pass.volume;
  return m;
}

flute_grinder::PlanReport toMessage(const PlannedJob& plan) {
  flute_grinder::PlanReport m;
  const Range complete = plan.complete.value_or(Range{kNone, kNone});
  m.valid = static_cast<std::uint8_t>(plan.good());
  m.statistics = toMessage(plan.statistics);
  m.complete = {complete.from, complete.to};
  for (const GroundFigure& figure : plan.figures) m.figures.push_back(toMessage(figure));
  if (plan.passes) {
    for (const PassRemoval& pass : *plan.passes) m.passes.push_back(toMessage(pass));
  }
  if (plan.program) m.shank_cut = shankCut(plan.program->job()->cutter);
  if (plan.closest) {
    m.closest_bodies = {plan.closest->first, plan.closest->second};
    m.closest_distance = plan.closest->distance;
    m.closest_x = plan.closest->axes[kX];
  }
  return m;
}

}  // namespace

int errorCode(PlanFault fault) {
  switch (fault) {
    case PlanFault::kNone: return flute_grinder::GrindResult::SUCCESSFUL;
    case PlanFault::kLimit: return flute_grinder::GrindResult::LIMIT_VIOLATED;
    case PlanFault::kTolerance: return flute_grinder::GrindResult::PATH_TOLERANCE_VIOLATED;
    case PlanFault::kInvalidJob:
    case PlanFault::kTool:
    case PlanFault::kCollision:
    case PlanFault::kTooLong: return flute_grinder::GrindResult::INVALID_GOAL;
    case PlanFault::kGivenUp: return flute_grinder::GrindResult::CANCELED;
  }
  return flute_grinder::GrindResult::INVALID_GOAL;
}

int errorCode(FaultKind fault) {
  switch (rowOf(fault).fault_class) {
    case FaultClass::kNone: return flute_grinder::GrindResult::SUCCESSFUL;
    case FaultClass::kEmergencyStop: return flute_grinder::GrindResult::EMERGENCY_STOP;
    case FaultClass::kHardware: return flute_grinder::GrindResult::HARDWARE_FAULT;
    case FaultClass::kLinkLost: return flute_grinder::GrindResult::LINK_LOST;
    case FaultClass::kTolerance: return flute_grinder::GrindResult::PATH_TOLERANCE_VIOLATED;
    case FaultClass::kLimit: return flute_grinder::GrindResult::LIMIT_VIOLATED;
    case FaultClass::kNotReady: return flute_grinder::GrindResult::NOT_READY;
  }
  return flute_grinder::GrindResult::HARDWARE_FAULT;
}

flute_grinder::GrindResult resultOf(const PlannedJob& plan) {
  flute_grinder::GrindResult m;
  m.error_code = plan.good() ? flute_grinder::GrindResult::SUCCESSFUL : errorCode(plan.fault);
  m.error_string = text(plan.reasons);
  m.reasons = toMessage(plan.reasons);
  m.plan = toMessage(plan);
  return m;
}

GroundFigure fromMessage(const flute_grinder::ToolFigure& m) {
  GroundFigure figure{static_cast<ToolFigure>(m.figure),
                      {m.ground[0], m.x[0], m.tooth[0]},
                      {m.ground[1], m.x[1], m.tooth[1]},
                      std::nullopt,
                      m.tolerance};
  if (!std::isnan(m.asked[0])) figure.asked = {m.asked[0], m.asked[1]};
  return figure;
}

std::string passText(const flute_grinder::PlanReport& plan, std::size_t number) {
  const flute_grinder::PassRemoval& pass = plan.passes[number];
  const std::string depth = format("%.4f mm, ", pass.depth / kMillimetre);
  if (pass.area > 0) {
    return depth + format("%.4g mm^2, %.3g mm^3/s", pass.area / units::kMillimetre2, pass.rate / units::kMillimetre3);
  }
  const bool is_spark_out = number > 0 && pass.depth == plan.passes[number - 1].depth;
  return depth + (is_spark_out ? "spark-out" : "removes nothing");
}

std::string closestText(const flute_grinder::PlanReport& plan) {
  if (plan.closest_bodies.size() != 2) return "";
  return plan.closest_bodies[0] + " and " + plan.closest_bodies[1] +
         format(", %.3f mm at X %.3f mm", plan.closest_distance / kMillimetre, plan.closest_x / kMillimetre);
}

std::string text(const flute_grinder::FeedLimit& limit) {
  return limit.cause + format(", X %.3f to %.3f mm", limit.from_x / kMillimetre, limit.to_x / kMillimetre);
}

}  // namespace grinder
