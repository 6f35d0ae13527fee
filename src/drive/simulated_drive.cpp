#include "drive/simulated_drive.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/drive/export_drive.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <thread>
#include <utility>

namespace grinder {

namespace {

constexpr double kSlip = 0.002;        ///< slip of the swivel [rad]
constexpr double kFlickerAt = 0.2e-3;  ///< distance from the surface at which the contact flickers [m]
constexpr std::chrono::milliseconds kHangStep{1};

constexpr std::array<const char*, 12> kFaultNames{"none",         "emergency_stop", "stuck_axis",     "stale_feedback",
                                                  "nan_feedback", "drive_fault",    "reference_lost", "spindle_lost",
                                                  "coolant_lost", "swivel_slipped", "probe_flickers", "hang"};

/// A view of the axes' values for arithmetic.
auto axes(AxisValues& buffer) { return Eigen::Map<Axes>(buffer.data()); }

/// Processor time that this thread has used [ns].
std::int64_t processorTime() {
  timespec used;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return used.tv_sec * 1000000000LL + used.tv_nsec;
}

/// @param root parameters of the node. @param p parameters of the drive.
SimulatedDrive::Blank readBlank(const ParameterReader& root, const ParameterReader& p) {
  constexpr double max = 10;
  const auto figure = [](const ParameterReader& from, const std::string& name, const About& about = {}) {
    return from.number(name, -max, max, about);
  };
  const char *nothing = "nothing to touch", *no_flutes = "no flutes";
  SimulatedDrive::Blank blank;
  blank.end_face =
      figure(p, "blank/end_face",
             {"X of the end face of what the measuring probe touches, in machine coordinates", "m", nothing});
  blank.diameter = p.number("blank/diameter", 0, max, {"diameter of the blank", "m", nothing});
  blank.run_out =
      p.number("blank/run_out", 0, max,
               {"total run-out of the blank; at A = 0 the axis is displaced toward the wheel", "m", nothing});
  if (p.has("blank/rake_face")) {
    blank.rake_face = {figure(p, "blank/rake_face/height",
                              {"height above the work spindle's axis of a plane below which the blank is ground away",
                               "m", no_flutes}),
                       p.number("blank/rake_face/angle", -units::kPi, units::kPi,
                                {"A at which that plane is horizontal", "rad", no_flutes})};
  }
  blank.ball_diameter = root.number("geometry/probe/diameter", 0, max);
  blank.ball_centre = {figure(root, "geometry/probe/x"),
                       figure(root, "geometry/probe/y") - figure(root, "geometry/work_axis/y"),
                       figure(root, "geometry/probe/z") - figure(root, "geometry/work_axis/z")};
  return blank;
}

}  // namespace

SimulatedDrive::Simulation SimulatedDrive::readSimulation(const ParameterReader& root, const ParameterReader& p) {
  Simulation simulation;
  Model& model = simulation.model;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const std::string joint = std::string(kJointNames[i]) + "/";
    model[i].time_constant = p.number(joint + "time_constant", 0, 10, {"servo lag", "s"});
    model[i].counts_per_unit = p.number(joint + "counts_per_unit", 1, 1e12, {"encoder resolution", "1/m, 1/rad"});
    model[i].start_position = p.number(joint + "start_position", -1e6, 1e6, {"position at power-up", "m, rad"});
    model[i].home_position = p.number(joint + "home_position", -1e6, 1e6, {"position of the reference", "m, rad"});
    model[i].homing_velocity =
        p.number(joint + "homing_velocity", 1e-6, 1e3, {"speed toward the reference", "m/s, rad/s"});
  }
  Equipment& equipment = simulation.equipment;
  equipment.absolute_encoders = p.flag("absolute_encoders", {"if true, homed from the start"});
  equipment.spindle_run_up_time = p.number("spindle_run_up_time", 0, 600, {"time until the spindle is at speed", "s"});
  if (p.has("pace"))
    equipment.pace = p.number("pace", 1, 100, {"simulated time over the clock's, for trials", "", "1"});
  if (p.has("swivel"))
    equipment.swivel =
        p.number("swivel", -1.57, 1.57, {"angle that the swivel's encoder reads", "rad", "the swivel has no encoder"});
  if (p.has("blank")) simulation.blank = readBlank(root, p);
  p.refuseUnknown({"type"});
  return simulation;
}

void SimulatedDrive::init(ros::NodeHandle& node_nh, ros::NodeHandle& drive_nh) {
  const Simulation simulation = readSimulation(ParameterReader(node_nh), ParameterReader(drive_nh));
  init(simulation.model, simulation.equipment);
  blank_ = simulation.blank;
  inject_service_ = drive_nh.advertiseService("inject_fault", &SimulatedDrive::onInjectFault, this);
}

void SimulatedDrive::init(const Model& model, const Equipment& equipment) {
  model_ = model;
  equipment_ = equipment;
  status_.homed = equipment.absolute_encoders;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const int axis = static_cast<int>(i);
    motor_[axis] = model[i].start_position;
    offset_[axis] = status_.homed ? 0 : motor_[axis];
    time_constant_[axis] = model[i].time_constant;
    counts_per_unit_[axis] = model[i].counts_per_unit;
    command_.position[i] = motor_[axis] - offset_[axis];
  }
}

DriveCapabilities SimulatedDrive::capabilities() const {
  DriveCapabilities can;
  can.homing = can.spindle = can.coolant = can.probe = true;
  can.swivel = std::isfinite(equipment_.swivel);
  return can;
}

void SimulatedDrive::read(const DriveCycle& cycle, DriveFeedback& feedback) {
  while (static_cast<Fault>(injected_ & 0xff) == Fault::kHang) std::this_thread::sleep_for(kHangStep);
  const std::uint16_t injected = injected_;
  const auto fault = static_cast<Fault>(injected & 0xff);
  const int failing_axis = injected >> 8;
  const double dt = cycle.period.toSec();

  readSwitches(fault);
  readEquipment(fault, dt);
  const bool fresh = fault != Fault::kStaleFeedback;
  if (fresh) ++status_.feedback_count;
  const Axes last = motor_;
  moveMotors(fault, failing_axis, dt);
  if (blank_) status_.probe_contact = readProbe(*blank_, fault);
  feedback.status = status_;
  if (!fresh) return;
  axes(feedback.velocity) = dt > 0 ? Axes((motor_ - last) / dt) : Axes::Zero();
  const Axes counts = ((motor_ - offset_) * counts_per_unit_).unaryExpr([](double v) { return std::rint(v); });
  axes(feedback.position) = counts / counts_per_unit_;
  if (fault == Fault::kNanFeedback) axes(feedback.position)[failing_axis] = std::numeric_limits<double>::quiet_NaN();
}

void SimulatedDrive::readSwitches(Fault fault) {
  status_.emergency_stop = fault == Fault::kEmergencyStop;
  if (fault == Fault::kDriveFault) {
    status_.fault = true;
    status_.fault_text = "injected";
  } else if (command_.reset) {
    status_.fault = false;
  }
  if (!command_.enable) power_off_ = false;
  status_.enabled = command_.enable && !status_.emergency_stop && !status_.fault && !power_off_;
}

void SimulatedDrive::readEquipment(Fault fault, double dt) {
  if (fault == Fault::kReferenceLost) status_.homed = false;
  const double change = equipment_.spindle_run_up_time > 0 ? dt / equipment_.spindle_run_up_time : 1;
  spindle_speed_ = std::clamp(spindle_speed_ + (command_.spindle ? change : -change), 0.0, 1.0);
  if (fault == Fault::kSpindleLost) spindle_speed_ = 0;
  status_.spindle_at_speed = spindle_speed_ >= 1;
  status_.coolant_on = command_.coolant && fault != Fault::kCoolantLost;
  status_.swivel = equipment_.swivel + (fault == Fault::kSwivelSlipped ? kSlip : 0);
}

bool SimulatedDrive::readProbe(const Blank& blank, Fault fault) {
  Blank film = blank;
  film.ball_diameter += 2 * kFlickerAt;
  const bool was_near = std::exchange(probe_near_, touches(film));
  const bool flickers = fault == Fault::kProbeFlickers && probe_near_ && !was_near;
  return flickers || touches(blank);
}

bool SimulatedDrive::touches(const Blank& blank) const {
  const double radius = blank.ball_diameter / 2;
  const double x = blank.ball_centre[0] + motor_[kX], y = blank.ball_centre[1] + motor_[kY],
               z = blank.ball_centre[2] + motor_[kZ];
  const double before_end = std::max(0.0, blank.end_face - x);
  if (blank.rake_face) {
    // The ball's place in the frame of the rake face.
    const double a = motor_[kA] - blank.rake_face->angle;
    const double below = blank.rake_face->height - (y * std::sin(a) + z * std::cos(a));
    if (below > 0) return before_end == 0 && below <= radius;
  }
  const double eccentricity = blank.run_out / 2;
  const double from_axis = std::hypot(y - eccentricity * std::cos(motor_[kA]), z + eccentricity * std::sin(motor_[kA]));
  return std::hypot(before_end, std::max(0.0, from_axis - blank.diameter / 2)) <= radius;
}

void SimulatedDrive::moveMotors(Fault fault, int failing_axis, double dt) {
  const bool home_is_new = command_.home && !home_was_commanded_;
  home_was_commanded_ = command_.home;
  if (home_is_new) status_.homed = false;
  status_.homing = status_.enabled && command_.home && (home_is_new || status_.homing);
  // Homing is reported in at least one reading, even over a very short distance.
  if (!status_.enabled || home_is_new) return;
  const double stuck = motor_[failing_axis];
  if (status_.homing) {
    home(dt);
  } else if (!command_.home) {
    motor_ += (axes(command_.position) + offset_ - motor_) * (dt / (time_constant_ + dt));
  }
  if (fault == Fault::kStuckAxis) motor_[failing_axis] = stuck;
}

void SimulatedDrive::home(double dt) {
  // One axis at a time, starting with Y, which moves the wheel away from the workpiece.
  for (const int i : {kY, kX, kZ, kA}) {
    const AxisModel& axis = model_[static_cast<std::size_t>(i)];
    const double distance = axis.home_position - motor_[i];
    if (distance == 0) continue;
    const double step = axis.homing_velocity * dt;
    motor_[i] = std::abs(distance) <= step ? axis.home_position : motor_[i] + std::copysign(step, distance);
    return;
  }
  offset_.setZero();
  status_.homing = false;
  status_.homed = true;
}

void SimulatedDrive::write(const DriveCycle&, const DriveCommand& command) { command_ = command; }

ros::Duration SimulatedDrive::wait(const ros::Duration& nominal) {
  if (equipment_.pace == 1) return Drive::wait(nominal);
  // One rest for many cycles: two system calls per cycle would cost the host more than the cycles themselves.
  ahead_ += nominal * (1 / equipment_.pace);
  if (ahead_ < nominal) return nominal;
  // At its priority a loop that never rests would starve the host's other programs of a core.
  const std::int64_t last_ns = std::exchange(processor_ns_, processorTime());
  Drive::wait(
      std::max(std::exchange(ahead_, ros::Duration()), ros::Duration().fromNSec(2 * (processor_ns_ - last_ns))));
  return nominal;
}

void SimulatedDrive::inject(Fault fault, int axis) {
  injected_ = static_cast<std::uint16_t>(static_cast<unsigned>(fault) | static_cast<unsigned>(axis) << 8);
}

bool SimulatedDrive::onInjectFault(flute_grinder::InjectFault::Request& request,
                                   flute_grinder::InjectFault::Response& response) {
  const auto named = std::find(kFaultNames.begin(), kFaultNames.end(), request.fault);
  response.success = named != kFaultNames.end() && request.axis < kAxisCount;
  if (named == kFaultNames.end()) {
    response.message = "fault = " + request.fault + "; allowed: ";
    for (const char* name : kFaultNames) response.message += std::string(name == kFaultNames[0] ? "" : ", ") + name;
  } else if (request.axis >= kAxisCount) {
    response.message = axisRefusal(request.axis);
  } else {
    inject(static_cast<Fault>(named - kFaultNames.begin()), request.axis);
  }
  return true;
}

}  // namespace grinder

FLUTE_GRINDER_EXPORT_DRIVE(grinder::SimulatedDrive)
