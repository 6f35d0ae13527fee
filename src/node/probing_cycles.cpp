#include "node/probing_cycles.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/tool/rake_touch.h"
#include "flute_grinder/tool/z_law.h"
#include "node/plain_name.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Maximum difference of a measured diameter from the known one [m]; a larger one means another cylinder.
constexpr double kMostOff = 1 * units::kMillimetre;

/// The context of a cycle.
struct Cycle {
  Prober& prober;
  const flute_grinder::ProbeGoal& goal;
  const WorkOffsets& offsets;
  const MachineGeometry& geometry;
  flute_grinder::ProbeResult& result;

  double ballRadius() const { return geometry.probe->diameter / 2; }

  /// The ball's centre in machine coordinates, at a touch [m].
  Eigen::Vector3d ballAt(const Prober::Touch& touch) const {
    return geometry.probe->centre + Eigen::Vector3d(touch.axes[kX], touch.axes[kY], touch.axes[kZ]);
  }
  /// The ball's centre from the work spindle's axis, X in machine coordinates [m].
  Eigen::Vector3d ballFromAxis(const Prober::Touch& touch) const {
    return ballAt(touch) - Eigen::Vector3d(0, geometry.work_axis_y, geometry.work_axis_z);
  }

  void add(const char* name, double value, double spread = kNone, bool angle = false) const {
    flute_grinder::ProbedFigure figure;
    figure.name = name;
    figure.angle = static_cast<std::uint8_t>(angle);
    figure.value = value;
    figure.spread = spread;
    result.figures.push_back(figure);
  }
};

/// A length in mm, to 0.1 um, the resolution of a probe.
std::string millimetres(double metres) { return format("%.4f mm", metres / units::kMillimetre); }

double endFace(const Cycle& cycle) {
  const Prober::Touch touch = cycle.prober.touch(kX, cycle.goal.within);
  const double face = cycle.ballAt(touch).x() + cycle.ballRadius();
  const double stickout = cycle.geometry.collet_face - face;
  cycle.add("end face", face, touch.spread);
  cycle.add("stick-out", stickout);
  if (!cycle.goal.set_offset) return kNone;
  const GrindJob job = jobFromGoal(cycle.goal.job);
  if (!(stickout >= job.cutter.flute_length)) {
    throw ProbingError("stick-out = " + millimetres(stickout) + "; allowed: the flutes' length or more, " +
                       millimetres(job.cutter.flute_length));
  }
  return workZero(cycle.geometry, job, {cycle.goal.flange, stickout}).x();
}

double diameter(const Cycle& cycle) {
  std::array<double, 4> sides{};
  double spread = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i > 0) cycle.prober.turn(units::kPi / 2);
    const Prober::Touch touch = cycle.prober.touch(kY, -cycle.goal.within);
    const Eigen::Vector3d ball = cycle.ballFromAxis(touch);
    sides[i] = 2 * (std::hypot(ball.y(), ball.z()) - cycle.ballRadius());
    spread = std::max(spread, touch.spread);
  }
  cycle.prober.turn(-1.5 * units::kPi);
  const double diameter = (sides[0] + sides[1] + sides[2] + sides[3]) / 4;
  cycle.add("diameter", diameter, spread);
  cycle.add("run-out", std::hypot(sides[0] - sides[2], sides[1] - sides[3]) / 2);
  if (!cycle.goal.set_offset) return kNone;
  if (!(std::abs(diameter - cycle.goal.diameter) <= kMostOff)) {
    throw ProbingError("diameter = " + millimetres(diameter) + ", known as " + millimetres(cycle.goal.diameter) +
                       "; allowed: up to " + millimetres(kMostOff) + " apart");
  }
  // Error of the machine's Y, from the measured diameter.
  const double off = (diameter - cycle.goal.diameter) / 2;
  return workZero(cycle.geometry, jobFromGoal(cycle.goal.job), {}).y() + off;
}

double tooth(const Cycle& cycle) {
  if (!cycle.offsets.axes[kX].wasSet()) {
    throw ProbingError("the work offset of X was never set; probe the end face first");
  }
  const ValidJob job = withLaws(ValidJob(jobFromGoal(cycle.goal.job)));
  // The rake face of a right-hand tooth comes down to the ball as A grows.
  const double toward = job->cutter.cut == CutDirection::kLeftHand ? -1 : 1;
  const Prober::Touch touch = cycle.prober.touch(kA, toward * cycle.goal.within);
  cycle.add("tooth 1", touch.axes[kA], touch.spread, true);
  Eigen::Vector3d ball = cycle.ballFromAxis(touch);
  ball.x() -= cycle.offsets.axes[kX].value + wheelCentre(cycle.geometry, job->process(), cycle.goal.flange).x();
  return touch.axes[kA] - rakeTouchAngle(job, ball, cycle.geometry.probe->diameter);
}

}  // namespace

std::string goalRefusal(const flute_grinder::ProbeGoal& goal) {
  if (!(goal.cycle < countOf<ProbingCycle>())) {
    return "cycle = " + std::to_string(goal.cycle) + "; allowed: 0 to " + std::to_string(countOf<ProbingCycle>() - 1);
  }
  if (!(goal.within > 0 && std::isfinite(goal.within))) {
    return format("within = %g; allowed: finite, and above 0", goal.within);
  }
  if (!goal.set_offset) {
    return goal.cycle == flute_grinder::ProbeGoal::TOOTH ? "set_offset = false; allowed: true, for TOOTH" : "";
  }
  if (!std::isfinite(goal.flange)) return format("flange = %g; allowed: finite", goal.flange);
  if (goal.cycle == flute_grinder::ProbeGoal::DIAMETER && !(goal.diameter > 0 && std::isfinite(goal.diameter))) {
    return format("diameter = %g; allowed: finite, and above 0", goal.diameter);
  }
  if (!isPlainName(goal.set_by)) return nameRefusal("set_by", goal.set_by);
  if (!isPlainName(goal.job.job_name)) return nameRefusal("job_name", goal.job.job_name);
  if (!isPlainName(goal.job.wheel_name)) return nameRefusal("wheel_name", goal.job.wheel_name);
  return text(validate(jobFromGoal(goal.job)));
}

double runCycle(Prober& prober, const flute_grinder::ProbeGoal& goal, const WorkOffsets& offsets,
                flute_grinder::ProbeResult& result) {
  const Cycle cycle{prober, goal, offsets, prober.config().geometry, result};
  switch (static_cast<ProbingCycle>(goal.cycle)) {
    case ProbingCycle::kEndFace: return endFace(cycle);
    case ProbingCycle::kDiameter: return diameter(cycle);
    case ProbingCycle::kTooth: break;
  }
  return tooth(cycle);
}

}  // namespace grinder
