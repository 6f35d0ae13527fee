#include "cli/probe.h"

#include "cli/call.h"
#include "cli/interrupt.h"
#include "cli/offsets.h"
#include "cli/stop_keys.h"
#include "cli/zeros.h"
#include "flute_grinder/JogStep.h"
#include "flute_grinder/Probe.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/geometry/rake_touch.h"
#include "flute_grinder/geometry/z_law.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/quantity.h"
#include "flute_grinder/messages/offset_basis.h"

#include <std_msgs/Header.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

namespace flute_grinder {

namespace {

using units::kMillimetre;

const ros::WallDuration kProbing(86400);  ///< longest time of a probing move
/// Between messages that this program is alive; and between holds after a key that stops, since a motion may be just
/// about to begin.
const ros::WallDuration kAgain(0.05);
constexpr double kTurned = 1e-4;  ///< within which half a turn has reached its end [rad]

/// To 0.1 um, or as much of a degree: a probe is no better.
std::string shown(double si, Unit unit = Unit::kMetre) {
  return format("%.4f %s", si / shopScale(unit), unit == Unit::kMetre ? "mm" : "deg");
}

/// Why there is no result, after it was printed.
struct Failed {
  int status;
};

/// A connected grinder with a measuring probe. Ctrl-C, Ctrl-Z and the end of this program stop its motion.
class ProbedMachine {
 public:
  /// @throw Failed
  explicit ProbedMachine(const std::string& node) : nh_(node), watch_(nh_), keys_(nh_, watch_) {
    alive_ = nh_.advertise<std_msgs::Header>("probe_alive", 1);
    if (!await(kPatience, [&] { return watch_.begun() && keys_.connected() && alive_.getNumSubscribers() > 0; }))
      throw Failed{noGrinder(nh_)};
    geometry_ = geometryOf(nh_);
    if (!geometry_.probe) throw Failed{fail("parameter " + nh_.getNamespace() + "/geometry/probe is missing")};
    catchInterrupts();
    catchHolds();
    keys_.start([this] { keys_.hold(); });
    again_ = nh_.createWallTimer(kAgain, [this](const ros::WallTimerEvent&) {
      std_msgs::Header alive;
      alive.stamp = ros::Time::now();
      alive_.publish(alive);
      if (stopped()) keys_.hold();
    });
  }

  const MachineGeometry& geometry() const { return geometry_; }
  double ballRadius() const { return geometry_.probe->diameter / 2; }
  GrinderState state() const { return watch_.newest(); }
  ros::NodeHandle& nodeHandle() { return nh_; }

  /// The ball's centre in machine coordinates, at a touch [m].
  Eigen::Vector3d ballAt(const Probe::Response& touch) const {
    return geometry_.probe->centre + Eigen::Vector3d(touch.axes[kX], touch.axes[kY], touch.axes[kZ]);
  }
  /// The same from the work spindle's axis, X in machine coordinates [m].
  Eigen::Vector3d ballFromAxis(const Probe::Response& touch) const {
    return ballAt(touch) - Eigen::Vector3d(0, geometry_.work_axis_y, geometry_.work_axis_z);
  }

  /// @param distance signed [m], A [rad]. @throw Failed
  Probe::Response probe(int axis, double distance) {
    Probe::Request request;
    request.axis = static_cast<std::uint8_t>(axis);
    request.distance = distance;
    request.stops = stops_;
    checkStop();
    Probe::Response touch;
    const auto lost = [this] { return watch_.lost(); };
    if (const int status = call<Probe>(nh_, "probe", request, &touch, kProbing, lost)) throw Failed{status};
    stops_ = touch.stops;
    touch.axes[static_cast<std::size_t>(axis)] = touch.position;
    return touch;
  }

  /// Turns the work. @throw Failed
  void turn(double angle) {
    if (!watch_.awaitNext()) throw Failed{fail(kLinkLost)};
    const double end = state().position[kA] + angle;
    JogStep::Request request;
    request.axis = kA;
    request.distance = angle;
    request.stops = stops_;
    checkStop();
    if (const int status = call<JogStep>(nh_, "jog_step", request)) throw Failed{status};
    do {
      if (!watch_.awaitNext()) throw Failed{fail(kLinkLost)};
    } while (state().state == GrinderState::JOGGING);
    if (!(std::abs(state().position[kA] - end) <= kTurned)) throw Failed{fail("A was stopped before its end")};
  }

  /// @param job file, for which it is set. @throw Failed
  void setOffset(int axis, double value, const std::string& job) {
    checkStop();
    const core::OffsetBasis basis = basisOf(goalFromFile(job), OffsetMethod::kProbe);
    if (const int status = setWorkOffset(nh_, axis, value, basis, true)) throw Failed{status};
    std::printf("%-15s %c %s\n", "work offset", "XYZA"[axis], shown(value, unitOf(axis, 0)).c_str());
  }

 private:
  static bool stopped() { return interrupts() + holds() > 0; }
  static void checkStop() {
    if (stopped()) throw Failed{fail("stopped")};
  }

  ros::NodeHandle nh_;
  StateWatch watch_;
  StopKeys keys_;
  MachineGeometry geometry_;
  ros::Publisher alive_;
  ros::WallTimer again_;
  std::uint64_t stops_ = 0;  ///< of the grinder's last answer; a later stop refuses the next motion
};

void printTouch(const char* name, double value, double spread, int axis) {
  const Unit unit = unitOf(axis, 0);
  std::printf("%-15s %s, spread %s\n", name, shown(value, unit).c_str(), shown(spread, unit).c_str());
}

template <typename Cycle>
int withMachine(const std::string& node, const Cycle& cycle) {
  try {
    ProbedMachine machine(node);
    cycle(machine);
    return 0;
  } catch (const Failed& failed) {
    return failed.status;
  }
}

/// The diameter of a circle about the work spindle's axis that the ball touches from outside [m].
double diameterTouched(const Eigen::Vector3d& ball, double ball_radius) {
  return 2 * (std::hypot(ball.y(), ball.z()) - ball_radius);
}

}  // namespace

int probeEndFace(const std::string& node, const ProbeOptions& options) {
  const GrindJob job = readJobFile(options.job);
  const double flange = flangeOf(options.job, options.flange_mm);
  return withMachine(node, [&](ProbedMachine& machine) {
    const Probe::Response touch = machine.probe(kX, options.within_mm * kMillimetre);
    const double face = machine.ballAt(touch).x() + machine.ballRadius();
    const double stickout = machine.geometry().collet_face - face;
    printTouch("end face", face, touch.spread, kX);
    std::printf("%-15s %s\n", "stick-out", shown(stickout).c_str());
    if (!(stickout >= job.cutter.flute_length)) {
      throw Failed{fail("stick-out = " + shown(stickout) + "; allowed: the flutes' length or more, " +
                        shown(job.cutter.flute_length))};
    }
    machine.setOffset(kX, workZero(machine.geometry(), job, {flange, stickout}).x(), options.job);
  });
}

int probeDiameter(const std::string& node, const ProbeOptions& options) {
  if (options.at_mm.has_value() == options.job.empty()) {
    throw std::invalid_argument("--at, the diameter of the blank, and --job; allowed: both or none");
  }
  const std::optional<GrindJob> job = options.job.empty() ? std::nullopt : std::optional(readJobFile(options.job));
  return withMachine(node, [&](ProbedMachine& machine) {
    const auto probe = [&] { return machine.probe(kY, -options.within_mm * kMillimetre); };
    std::array<double, 4> sides{};
    double spread = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (i > 0) machine.turn(units::kPi / 2);
      const Probe::Response touch = probe();
      sides[i] = diameterTouched(machine.ballFromAxis(touch), machine.ballRadius());
      spread = std::max(spread, touch.spread);
    }
    machine.turn(-1.5 * units::kPi);
    const double diameter = (sides[0] + sides[1] + sides[2] + sides[3]) / 4;
    printTouch("diameter", diameter, spread, kY);
    std::printf("%-15s %s\n", "run-out", shown(std::hypot(sides[0] - sides[2], sides[1] - sides[3]) / 2).c_str());
    if (!job) return;
    // By how much the machine's Y is off, as this diameter shows.
    const double off = (diameter - *options.at_mm * kMillimetre) / 2;
    machine.setOffset(kY, workZero(machine.geometry(), *job, {}).y() + off, options.job);
  });
}

int probeTooth(const std::string& node, const ProbeOptions& options) {
  const GrindJob job = withZLaw(readJobFile(options.job));
  const double flange = flangeOf(options.job, options.flange_mm);
  return withMachine(node, [&](ProbedMachine& machine) {
    const std::optional<WorkOffsets> offsets = workOffsets(machine.nodeHandle());
    if (!offsets) throw Failed{noGrinder(machine.nodeHandle())};
    if (offsets->set_at[kX].isZero()) {
      throw Failed{fail("the work offset of X was never set; probe the end face first")};
    }
    // The rake face of a right-hand tooth comes down to the ball as A grows.
    const double toward = job.cutter.cut == CutDirection::kLeftHand ? -1 : 1;
    const Probe::Response touch = machine.probe(kA, toward * options.within_deg * units::kDegree);
    Eigen::Vector3d ball = machine.ballFromAxis(touch);
    ball.x() -= offsets->values[kX] + wheelCentre(machine.geometry(), job.process, flange).x();
    printTouch("tooth 1", touch.position, touch.spread, kA);
    try {
      const double first_tooth = rakeTouchAngle(job, ball, machine.geometry().probe->diameter);
      machine.setOffset(kA, touch.position - first_tooth, options.job);
    } catch (const core::ReasonError& error) {
      throw Failed{fail(core::text(error.reason(), UnitSystem::kShop))};
    }
  });
}

}  // namespace flute_grinder
