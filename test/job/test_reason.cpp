#include "flute_grinder/job/reason.h"

#include "flute_grinder/job/axes.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/machine/loop_fault.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <set>
#include <string>

namespace grinder {
namespace test_reason {

using Kind = ReasonKind;

constexpr double kPi = 3.141592653589793238462643383279502884;

/// A reason and its texts by hand.
struct Row {
  Kind kind;
  const char* name;
  Unit unit;
  double value, limit;
  std::function<void(Reason&)> change;
  const char* si;
  const char* shop;
};

std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

void atStroke(Reason& r) {
  r.has_place = true;
  r.move = MoveKind::kStroke;
  r.tooth = 0;
  r.pass = 1;
  r.x = 0.0123;
  r.cycle = 1204;
}

std::function<void(Reason&)> field(const char* path, const char* detail = "") {
  return [=](Reason& r) { r.field = path, r.detail = detail; };
}

std::function<void(Reason&)> swivel(const char* detail) {
  return [=](Reason& r) { r.field = "process.setup_swivel", r.detail = detail, r.low = kPi / 1800; };
}

std::function<void(Reason&)> ofAxis(int axis) {
  return [=](Reason& r) { r.axis = axis; };
}

std::function<void(Reason&)> setpointsOf(int axis, std::uint64_t count = 1) {
  return [=](Reason& r) {
    atStroke(r);
    r.axis = axis;
    r.count = count;
  };
}

void nothing(Reason&) {}

const Row kRows[]{
    {Kind::kNone, "None", Unit::kNone, 0, 0, nothing, "", ""},
    {Kind::kOutOfRange, "Feed", Unit::kFeedMetrePerSecond, 0.25, 1.0 / 6,
     [](Reason& r) { r.field = "process.feed", r.low = 1e-4 / 60; },
     "process.feed = 0.25 m/s; allowed: 1.666666667e-06 to 0.1666666667 m/s",
     "process.feed_mm_min = 15000 mm/min; allowed: 0.1 to 10000 mm/min"},
    {Kind::kOutOfRange, "RotaryScale", Unit::kRotaryMetrePerRadian, 2, 1,
     [](Reason& r) { r.field = "interpolation.rotary_scale", r.low = 1e-6; },
     "interpolation.rotary_scale = 2 m/rad; allowed: 1e-06 to 1 m/rad",
     "interpolation.rotary_scale_mm_per_rad = 2000 mm/rad; allowed: 0.001 to 1000 mm/rad"},
    {Kind::kOutOfRange, "Choice", Unit::kNone, 9, 1, field("process.order"), "process.order = 9; allowed: 0 to 1",
     "process.order = 9; allowed: 0 to 1"},
    {Kind::kOutOfRange, "Swivel", Unit::kRadian, kPi / 2, kPi / 3,
     [](Reason& r) { r.field = "process.setup_swivel", r.detail = "to which the machine swivels", r.low = -kPi / 3; },
     "process.setup_swivel = 1.570796327 rad; allowed: -1.047197551 to 1.047197551 rad, to which the machine swivels",
     "process.setup.swivel_deg = 90 deg; allowed: -60 to 60 deg, to which the machine swivels"},
    {Kind::kNotBelow, "Depth", Unit::kMetre, 0.006, 0.005, field("process.depth", "the cutter's minimum radius"),
     "process.depth = 0.006 m; allowed: less than 0.005 m, the cutter's minimum radius",
     "process.depth_mm = 6 mm; allowed: less than 5 mm, the cutter's minimum radius"},
    {Kind::kAbove, "Finish", Unit::kMetre, 0.00075, 0.0005, field("process.finish_infeed", "the depth"),
     "process.finish_infeed = 0.00075 m; allowed: up to the depth, 0.0005 m",
     "process.finish_infeed_mm = 0.75 mm; allowed: up to the depth, 0.5 mm"},
    {Kind::kNotAllowed, "Teeth", Unit::kRadian, kPi / 2, 2 * kPi, field("cutter.tooth_angles", "ascending, below"),
     "cutter.tooth_angles = 1.570796327 rad; allowed: ascending, below 6.283185307 rad",
     "cutter.tooth_angles_deg = 90 deg; allowed: ascending, below 360 deg"},
    {Kind::kNotAllowed, "Infeed", Unit::kMetre, 0.0005, 0, field("process.infeed", "enough for 9 passes"),
     "process.infeed = 0.0005 m; allowed: enough for 9 passes",
     "process.infeed_mm = 0.5 mm; allowed: enough for 9 passes"},
    {Kind::kFeedTooLow, "FeedTooLow", Unit::kFeedMetrePerSecond, 1e-6, 1e-4 / 60,
     [](Reason& r) { r.detail = "axis_a velocity", r.x = 0.004; },
     "process.feed: axis_a velocity allows 1e-06 m/s at X = 0.004 m; the slowest feed is 1.66667e-06 m/s",
     "process.feed_mm_min: axis A velocity allows 0.06 mm/min at X = 4 mm; the slowest feed is 0.1 mm/min"},
    {Kind::kParkInWork, "ParkInWork", Unit::kMetre, 0.05, 0.0625, ofAxis(kY),
     "park position axis_y = 0.05 m; allowed for this job: at least 0.0625 m, clear of the work",
     "park position axis Y = 50 mm; allowed for this job: at least 62.5 mm, clear of the work"},
    {Kind::kTolerance, "Tolerance", Unit::kDeviationMetre, 2.5e-6, 1e-6, setpointsOf(kX, 3),
     "interpolation.tolerance = 1e-06 m: the path deviates by 2.5e-06 m at the maximum feed override (stroke, cycle "
     "1204, X = 0.0123 m); lower process.feed, or set interpolation.even_step to exact; the worst of 3 setpoints",
     "interpolation.tolerance_um = 1 um: the path deviates by 2.5 um at the maximum feed override (stroke, tooth 1, "
     "pass "
     "2, X = 12.3 mm); lower process.feed_mm_min, or set interpolation.even_step to exact; the worst of 3 setpoints"},
    {Kind::kTooLong, "TooLong", Unit::kSecond, 7200.5, 3600, [](Reason& r) { r.count = 12; },
     "max_job_duration = 3600 s: the job takes 7200.5 s or more for 12 passes of its teeth; raise process.feed or "
     "process.infeed, or the parameter",
     "max_job_duration = 3600 s: the job takes 7200.5 s or more for 12 passes of its teeth; raise process.feed_mm_min "
     "or "
     "process.infeed_mm, or the parameter"},
    {Kind::kTooLong, "TooLongByAnUnknownTime", Unit::kSecond, 0, 3600, [](Reason& r) { r.count = 1; },
     "max_job_duration = 3600 s: the job takes longer for 1 pass of its teeth; raise process.feed or process.infeed, "
     "or "
     "the parameter",
     "max_job_duration = 3600 s: the job takes longer for 1 pass of its teeth; raise process.feed_mm_min or "
     "process.infeed_mm, or the parameter"},
    {Kind::kGivenUp, "GivenUp", Unit::kNone, 0, 0, nothing, "given up while it was planned",
     "given up while it was planned"},
    {Kind::kGivenUp, "GivenUpForAnother", Unit::kNone, 0, 0, [](Reason& r) { r.detail = "a goal came first"; },
     "given up: a goal came first", "given up: a goal came first"},
    {Kind::kCollision, "Hit", Unit::kMetre, 0, 0.001,
     [](Reason& r) {
       r.detail = "wheel and collet";
       atStroke(r);
     },
     "collision_clearance = 0.001 m: wheel and collet hit each other (at stroke of tooth 1, pass 2, X = 0.0123 m); "
     "stick the blank out further, and set the zero of X anew",
     "collision_clearance = 1 mm: wheel and collet hit each other (stroke, tooth 1, pass 2, X = 12.3 mm); stick the "
     "blank out further, and set the zero of X anew"},
    {Kind::kCollision, "HitsTheShank", Unit::kMetre, 0, 0.001, field("", "wheel and shank"),
     "collision_clearance = 0.001 m: wheel and shank hit each other; change cutter.shank_diameter, cutter.neck_length "
     "or process.overtravel_shank",
     "collision_clearance = 1 mm: wheel and shank hit each other; change cutter.shank_diameter_mm, "
     "cutter.neck_length_mm or process.overtravel_mm[1]"},
    {Kind::kCollision, "HitsTheCutter", Unit::kMetre, 0, 0.001, field("", "spindle and cutter"),
     "collision_clearance = 0.001 m: spindle and cutter hit each other; change process.setup_swivel or "
     "process.wheel_diameter",
     "collision_clearance = 1 mm: spindle and cutter hit each other; change process.setup.swivel_deg or "
     "process.wheel.diameter_mm"},
    {Kind::kCollision, "TooClose", Unit::kMetre, 0.0004, 0.001, field("", "spindle and work_head"),
     "collision_clearance = 0.001 m: spindle and work_head come within 0.0004 m of each other; stick "
     "the blank out further, and set the zero of X anew",
     "collision_clearance = 1 mm: spindle and work_head come within 0.4 mm of each other; stick the "
     "blank out further, and set the zero of X anew"},
    {Kind::kCollision, "OutsideTheCut", Unit::kMetre, 0.0001, 0.00025,
     [](Reason& r) {
       r.field = "process.clearance";
       r.detail = "wheel and shank";
       r.low = 0.0005;
     },
     "process.clearance = 0.0005 m: wheel and shank come within 0.0001 m of each other outside the cut; allowed: "
     "0.00025 m or more; raise it",
     "process.clearance_mm = 0.5 mm: wheel and shank come within 0.1 mm of each other outside the cut; allowed: "
     "0.25 mm or more; raise it"},
    {Kind::kSwivel, "SwivelUnknown", Unit::kRadian, std::numeric_limits<double>::quiet_NaN(), kPi / 8, swivel(""),
     "process.setup_swivel = 0.3926990817 rad: the swivel is not confirmed; set it to 22.5 deg and confirm it: grind "
     "confirm-swivel 22.5",
     "process.setup.swivel_deg = 22.5 deg: the swivel is not confirmed; set it to 22.5 deg and confirm it: grind "
     "confirm-swivel 22.5"},
    {Kind::kSwivel, "SwivelConfirmed", Unit::kRadian, kPi / 6, -kPi / 8, swivel("confirmed"),
     "process.setup_swivel = -0.3926990817 rad: the swivel is confirmed at 0.5235987756 rad; allowed: within "
     "0.00174533 "
     "rad of that; set it to -22.5 deg and confirm it: grind confirm-swivel -22.5",
     "process.setup.swivel_deg = -22.5 deg: the swivel is confirmed at 30 deg; allowed: within 0.1 deg of that; set it "
     "to -22.5 deg and confirm it: grind confirm-swivel -22.5"},
    {Kind::kSwivel, "SwivelMeasured", Unit::kRadian, kPi / 6, kPi / 8, swivel("measured"),
     "process.setup_swivel = 0.3926990817 rad: the swivel stands at 0.5235987756 rad; allowed: within 0.00174533 rad "
     "of "
     "that; set it to 22.5 deg",
     "process.setup.swivel_deg = 22.5 deg: the swivel stands at 30 deg; allowed: within 0.1 deg of that; set it to "
     "22.5 "
     "deg"},
    {Kind::kOther, "Other", Unit::kNone, 0, 0, field("", "first_tooth = 1"), "first_tooth = 1", "first_tooth = 1"},
    {Kind::kPosition, "PositionOfX", Unit::kMetre, 0.401, 0.3, setpointsOf(kX),
     "axis_x position 0.401 m is 0.101 m beyond its limit 0.3 m (stroke, cycle 1204, X = 0.0123 m)",
     "axis X position 401 mm is 101 mm beyond its limit 300 mm (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kPosition, "PositionBelowItsLimit", Unit::kMetre, -0.0225, -0.02, setpointsOf(kY, 2),
     "axis_y position -0.0225 m is 0.0025 m beyond its limit -0.02 m (stroke, cycle 1204, X = 0.0123 m); the worst of "
     "2 "
     "setpoints",
     "axis Y position -22.5 mm is 2.5 mm beyond its limit -20 mm (stroke, tooth 1, pass 2, X = 12.3 mm); the worst of "
     "2 "
     "setpoints"},
    {Kind::kPosition, "PositionOfA", Unit::kRadian, kPi, kPi / 2, setpointsOf(kA),
     "axis_a position 3.14159 rad is 1.5708 rad beyond its limit 1.5708 rad (stroke, cycle 1204, X = 0.0123 m)",
     "axis A position 180 deg is 90 deg beyond its limit 90 deg (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kVelocity, "Velocity", Unit::kMetrePerSecond, -0.3, 0.2, setpointsOf(kY),
     "axis_y velocity -0.3 m/s is 0.1 m/s beyond its limit 0.2 m/s (stroke, cycle 1204, X = 0.0123 m)",
     "axis Y velocity -300 mm/s is 100 mm/s beyond its limit 200 mm/s (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kVelocity, "VelocityOfA", Unit::kRadianPerSecond, -kPi, kPi / 4, setpointsOf(kA),
     "axis_a velocity -3.14159 rad/s is 2.35619 rad/s beyond its limit 0.785398 rad/s (stroke, cycle 1204, X = 0.0123 "
     "m)",
     "axis A velocity -180 deg/s is 135 deg/s beyond its limit 45 deg/s (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kAcceleration, "Acceleration", Unit::kMetrePerSecond2, 3, 2, setpointsOf(kZ),
     "axis_z acceleration 3 m/s^2 is 1 m/s^2 beyond its limit 2 m/s^2 (stroke, cycle 1204, X = 0.0123 m)",
     "axis Z acceleration 3000 mm/s^2 is 1000 mm/s^2 beyond its limit 2000 mm/s^2 (stroke, tooth 1, pass 2, X = 12.3 "
     "mm)"},
    {Kind::kAcceleration, "AccelerationOfA", Unit::kRadianPerSecond2, kPi, kPi / 2, setpointsOf(kA),
     "axis_a acceleration 3.14159 rad/s^2 is 1.5708 rad/s^2 beyond its limit 1.5708 rad/s^2 (stroke, cycle 1204, X = "
     "0.0123 m)",
     "axis A acceleration 180 deg/s^2 is 90 deg/s^2 beyond its limit 90 deg/s^2 (stroke, tooth 1, pass 2, X = 12.3 "
     "mm)"},
    {Kind::kJerk, "Jerk", Unit::kMetrePerSecond3, 60, 50, setpointsOf(kX),
     "axis_x jerk 60 m/s^3 is 10 m/s^3 beyond its limit 50 m/s^3 (stroke, cycle 1204, X = 0.0123 m)",
     "axis X jerk 60000 mm/s^3 is 10000 mm/s^3 beyond its limit 50000 mm/s^3 (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kJerk, "JerkOfA", Unit::kRadianPerSecond3, kPi, kPi / 2, setpointsOf(kA),
     "axis_a jerk 3.14159 rad/s^3 is 1.5708 rad/s^3 beyond its limit 1.5708 rad/s^3 (stroke, cycle 1204, X = 0.0123 m)",
     "axis A jerk 180 deg/s^3 is 90 deg/s^3 beyond its limit 90 deg/s^3 (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kNotFinite, "NotFinite", Unit::kMetre, std::numeric_limits<double>::infinity(), 0.3, setpointsOf(kX),
     "axis_x position inf m is not a finite number (stroke, cycle 1204, X = 0.0123 m)",
     "axis X position inf mm is not a finite number (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kEmergencyStop, "EmergencyStop", Unit::kNone, 0, 0, nothing, "emergency stop", "emergency stop"},
    {Kind::kEmergencyStop, "EmergencyStopInAJob", Unit::kNone, 0, 0, atStroke,
     "emergency stop (at stroke of tooth 1, pass 2, X = 0.0123 m)",
     "emergency stop (stroke, tooth 1, pass 2, X = 12.3 mm)"},
    {Kind::kDriveFault, "DriveFault", Unit::kNone, 0, 0, nothing, "the drive reports a fault",
     "the drive reports a fault"},
    {Kind::kPowerLost, "PowerLost", Unit::kNone, 0, 0, nothing, "the drive has switched its power off",
     "the drive has switched its power off"},
    {Kind::kStaleFeedback, "StaleFeedback", Unit::kSecond, 0.06, 0.05, nothing,
     "no fresh positions from the drive for 0.06 s, allowed 0.05 s",
     "no fresh positions from the drive for 0.06 s, allowed 0.05 s"},
    {Kind::kInvalidFeedback, "InvalidFeedback", Unit::kMetre, std::numeric_limits<double>::infinity(), 0, ofAxis(kZ),
     "axis_z position from the drive is inf", "axis Z position from the drive is inf"},
    {Kind::kFollowingError, "FollowingError", Unit::kMetre, 0.0012, 0.001, ofAxis(kX),
     "axis_x following error 0.0012 m is beyond its limit 0.001 m",
     "axis X following error 1.2 mm is beyond its limit 1 mm"},
    {Kind::kFollowingError, "FollowingErrorOfA", Unit::kRadian, kPi / 30, kPi / 60, ofAxis(kA),
     "axis_a following error 0.10472 rad is beyond its limit 0.0523599 rad",
     "axis A following error 6 deg is beyond its limit 3 deg"},
    {Kind::kUnderrun, "Underrun", Unit::kNone, 3, 0, [](Reason& r) { r.cycle = 77; },
     "the axes found no setpoint in 3 servo cycles, after setpoint 77",
     "the axes found no setpoint in 3 servo cycles, after setpoint 77"},
    {Kind::kLate, "Late", Unit::kSecond, 0.052, 0.01, nothing,
     "the control loop came 0.052 s after the cycle before, allowed 0.01 s",
     "the control loop came 0.052 s after the cycle before, allowed 0.01 s"},
    {Kind::kHoming, "Homing", Unit::kSecond, 30.001, 30, nothing,
     "the drive has not found its reference after 30.001 s, allowed 30 s",
     "the drive has not found its reference after 30.001 s, allowed 30 s"},
    {Kind::kInterlock, "Interlock", Unit::kSecond, 10.5, 10, field("", "no coolant flows"),
     "no coolant flows 10.5 s after the job was started, allowed 10 s",
     "no coolant flows 10.5 s after the job was started, allowed 10 s"},
    {Kind::kRake, "Rake", Unit::kRadian, 0.25 * kPi, kPi / 18,
     [](Reason& r) {
       r.low = kPi / 360;
       r.tooth = 2;
       r.x = 0.0123;
     },
     "cutter.rake_angle = 0.174533 rad: tooth 3 is ground with 0.785398 rad at X = 0.0123 m; allowed: within "
     "0.00872665 rad "
     "of it; change process.setup_swivel or process.setup_height",
     "cutter.rake_angle_deg = 10 deg: tooth 3 is ground with 45 deg at X = 12.3 mm; allowed: within 0.5 deg of it; "
     "change "
     "process.setup.swivel_deg or process.setup.height_mm"},
    {Kind::kSpiral, "Spiral", Unit::kRadian, 0.25 * kPi, kPi / 6,
     [](Reason& r) {
       r.low = kPi / 360;
       r.tooth = 2;
       r.x = 0.0123;
     },
     "cutter.spiral_angle = 0.523599 rad: the edge of tooth 3 is ground with 0.785398 rad at X = 0.0123 m; allowed: "
     "within 0.00872665 rad of it; change process.setup_lead",
     "cutter.spiral_angle_deg = 30 deg: the edge of tooth 3 is ground with 45 deg at X = 12.3 mm; allowed: within 0.5 "
     "deg of it; change process.setup.lead_mm"},
    {Kind::kChordalRake, "ChordalRake", Unit::kRadian, 0.25 * kPi, kPi / 18,
     [](Reason& r) {
       r.low = kPi / 36;
       r.tooth = 2;
       r.x = 0.0123;
     },
     "cutter.rake_angle = 0.174533 rad: tooth 3 has a chordal rake of 0.785398 rad at X = 0.0123 m; allowed: within "
     "0.0872665 rad of it; change process.wheel_diameter or process.wheel_width",
     "cutter.rake_angle_deg = 10 deg: tooth 3 has a chordal rake of 45 deg at X = 12.3 mm; allowed: within 5 deg of "
     "it; "
     "change process.wheel.diameter_mm or process.wheel.width_mm"},
    {Kind::kCoreSize, "CoreSize", Unit::kMetre, 0.00713, 0.0068, [](Reason& r) { r.low = 2e-5; },
     "cutter.core_diameter, cutter.core_diameter_end: the core is 0.00713 m at X = 0 m; allowed: within 2e-05 m of "
     "0.0068 m; change process.depth or process.depth_end",
     "cutter.core_diameter_mm, cutter.core_diameter_end_mm: the core is 7.13 mm at X = 0 mm; allowed: within 0.02 mm "
     "of "
     "6.8 mm; change process.depth_mm or process.depth_end_mm"},
    {Kind::kLand, "Land", Unit::kRadian, 0.75 * kPi, 0.5 * kPi, [](Reason& r) { r.x = 0.0123; },
     "no land is left on tooth 1 at X = 0.0123 m: its flute takes 2.35619 rad, its pitch is 1.5708 rad; lower "
     "process.wheel_width or process.depth",
     "no land is left on tooth 1 at X = 12.3 mm: its flute takes 135 deg, its pitch is 90 deg; lower "
     "process.wheel.width_mm or process.depth_mm"},
    {Kind::kCore, "Core", Unit::kMetre, 0, 0, [](Reason& r) { r.x = 0.0123; },
     "process.depth: the core is cut through at X = 0.0123 m; lower it",
     "process.depth_mm: the core is cut through at X = 12.3 mm; lower it"},
    {Kind::kIncomplete, "Incomplete", Unit::kMetre, 0.025, 0.03, [](Reason& r) { r.low = 0.002; },
     "process.overtravel_end, process.overtravel_shank: the flutes are complete from X = 0.002 m to 0.025 m; allowed: "
     "over the "
     "whole flute length, 0 to 0.03 m, unless process.incomplete_ok is true",
     "process.overtravel_mm[0], process.overtravel_mm[1]: the flutes are complete from X = 2 mm to 25 mm; allowed: "
     "over the whole "
     "flute length, 0 to 30 mm, unless process.incomplete_ok is true"},
    {Kind::kIncomplete, "IncompleteAtTheMiddle", Unit::kMetre, 0, 0.03, nothing,
     "process.overtravel_end, process.overtravel_shank: the flutes are complete nowhere; allowed: over the whole flute "
     "length, 0 "
     "to 0.03 m, unless process.incomplete_ok is true",
     "process.overtravel_mm[0], process.overtravel_mm[1]: the flutes are complete nowhere; allowed: over the whole "
     "flute length, 0 "
     "to 30 mm, unless process.incomplete_ok is true"},
    {Kind::kUnevenRake, "UnevenRake", Unit::kRadian, kPi / 4, kPi / 18,
     [](Reason& r) {
       r.low = kPi / 36;
       r.tooth = 1;
     },
     "process.z_law = constant_rake: tooth 2 is ground with 0.0872665 rad to 0.785398 rad at best, asked 0.174533 rad; "
     "allowed: within 8.72665e-05 rad of it; change process.setup_swivel or process.setup_height, or raise "
     "process.overtravel_end or process.overtravel_shank",
     "process.z_law = constant_rake: tooth 2 is ground with 5 deg to 45 deg at best, asked 10 deg; allowed: within "
     "0.005 "
     "deg of it; change process.setup.swivel_deg or process.setup.height_mm, or raise process.overtravel_mm[0] or "
     "process.overtravel_mm[1]"},
    {Kind::kUnevenRake, "NoRakeFace", Unit::kRadian, 0, kPi / 18, [](Reason& r) { r.low = 1; },
     "process.z_law = constant_rake: tooth 1 has no rake face over its whole flute; change process.setup_swivel or "
     "process.setup_height, or raise process.overtravel_end or process.overtravel_shank",
     "process.z_law = constant_rake: tooth 1 has no rake face over its whole flute; change process.setup.swivel_deg or "
     "process.setup.height_mm, or raise process.overtravel_mm[0] or process.overtravel_mm[1]"},
    {Kind::kCanceled, "Canceled", Unit::kNone, 0, 0, atStroke,
     "canceled; stopped on the path (at stroke of tooth 1, pass 2, X = 0.0123 m)",
     "canceled; stopped on the path (stroke, tooth 1, pass 2, X = 12.3 mm)"},
};

class ReasonText : public ::testing::TestWithParam<Row> {};

TEST_P(ReasonText, IsThatByHandInBothUnitSystems) {
  const Row& row = GetParam();
  Reason reason;
  reason.kind = row.kind;
  reason.unit = row.unit;
  reason.value = row.value;
  reason.limit = row.limit;
  row.change(reason);
  EXPECT_EQ(text(reason, UnitSystem::kSi), row.si);
  EXPECT_EQ(text(reason, UnitSystem::kShop), row.shop);
}

INSTANTIATE_TEST_SUITE_P(ByHand, ReasonText, ::testing::ValuesIn(kRows),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Reason, EveryKindHasARow) {
  std::set<Kind> kinds;
  for (const Row& row : kRows) kinds.insert(row.kind);
  EXPECT_EQ(kinds.size(), static_cast<std::size_t>(kReasonKindCount));
}

TEST(Reason, OfEveryFaultHasText) {
  for (int kind = 1; kind <= static_cast<int>(FaultKind::kInterlock); ++kind) {
    LoopFault fault;
    fault.kind = static_cast<FaultKind>(kind);
    fault.interlock = Interlock::kSpindle;
    EXPECT_NE(fault.text(), "") << kind;
  }
  EXPECT_EQ(LoopFault().text(), "");
}

TEST(Reason, OfAViolationInTheLoopHasItsPlace) {
  LoopFault fault;
  fault.kind = FaultKind::kLimit;
  fault.violation = {kA, LimitedQuantity::kVelocity, -kPi, kPi / 2, 8, 0.03, MoveKind::kIndex, 2, 4};
  EXPECT_EQ(text(reasonOf(fault), UnitSystem::kShop),
            "axis A velocity -180 deg/s is 90 deg/s beyond its limit 90 deg/s (index, tooth 3, pass 5, X = 30 mm)");
}

TEST(Reason, ManyStandSideBySide) {
  Reason stop, other;
  stop.kind = Kind::kEmergencyStop;
  other.kind = Kind::kOther;
  other.detail = "busy";
  EXPECT_EQ(text(std::vector<Reason>{stop, other}, UnitSystem::kSi), "emergency stop; busy");
}

TEST(Reason, CausesOfFeedLimitsNameTheOperatorsAxes) {
  EXPECT_EQ(causeText("axis_a velocity", UnitSystem::kShop), "axis A velocity");
  EXPECT_EQ(causeText("axis_z jerk", UnitSystem::kShop), "axis Z jerk");
  EXPECT_EQ(causeText("axis_a velocity", UnitSystem::kSi), "axis_a velocity");
  EXPECT_EQ(causeText("interpolation tolerance", UnitSystem::kShop), "interpolation tolerance");
}

TEST(JobFields, HaveTheirNamesInTheJobFile) {
  EXPECT_EQ(fieldName("process.wheel_wear", UnitSystem::kShop), "process.wheel.wear_mm");
  EXPECT_EQ(fieldName("process.wheel_wear", UnitSystem::kSi), "process.wheel_wear");
  EXPECT_EQ(fieldName("process.spark_out", UnitSystem::kShop), "process.spark_out");
}

}  // namespace test_reason
}  // namespace grinder
