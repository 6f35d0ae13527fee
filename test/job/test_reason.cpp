#include "flute_grinder/job/reason.h"

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/machine/loop_fault.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>
#include <string>

namespace grinder {
namespace test_reason {

using Kind = ReasonKind;

constexpr double kPi = 3.141592653589793238462643383279502884;

/// A reason and its text by hand.
struct Row {
  Kind kind;
  Unit unit;
  double value, limit;
  std::function<void(Reason&)> change;
  std::string text;
};

const std::string kPlace = " (stroke, tooth 1, pass 2, X = 12.3 mm)";

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
  return [=](Reason& r) { atStroke(r), r.axis = axis, r.count = count; };
}

std::function<void(Reason&)> ofThirdTooth(double low = 0) {
  return [=](Reason& r) { r.low = low, r.tooth = 2, r.x = 0.0123; };
}

void nothing(Reason&) {}

const Row kRows[]{
    {Kind::kNone, Unit::kNone, 0, 0, nothing, ""},
    {Kind::kOutOfRange, Unit::kFeedMetrePerSecond, 0.25, 1.0 / 6,
     [](Reason& r) { r.field = "process.feed", r.low = 1e-4 / 60; },
     "process.feed_mm_min = 15000 mm/min; allowed: 0.1 to 10000 mm/min"},
    {Kind::kOutOfRange, Unit::kRotaryMetrePerRadian, 2, 1,
     [](Reason& r) { r.field = "interpolation.rotary_scale", r.low = 1e-6; },
     "interpolation.rotary_scale_mm_per_rad = 2000 mm/rad; allowed: 0.001 to 1000 mm/rad"},
    {Kind::kOutOfRange, Unit::kNone, 9, 1, field("process.order"), "process.order = 9; allowed: 0 to 1"},
    {Kind::kOutOfRange, Unit::kRadian, kPi / 2, kPi / 3,
     [](Reason& r) { r.field = "process.setup_swivel", r.detail = "to which the machine swivels", r.low = -kPi / 3; },
     "process.setup.swivel_deg = 90 deg; allowed: -60 to 60 deg, to which the machine swivels"},
    {Kind::kNotBelow, Unit::kMetre, 0.006, 0.005, field("process.depth", "the cutter's minimum radius"),
     "process.depth_mm = 6 mm; allowed: less than 5 mm, the cutter's minimum radius"},
    {Kind::kAbove, Unit::kMetre, 0.00075, 0.0005, field("process.finish_infeed", "the depth"),
     "process.finish_infeed_mm = 0.75 mm; allowed: up to the depth, 0.5 mm"},
    {Kind::kNotAllowed, Unit::kRadian, kPi / 2, 2 * kPi, field("cutter.tooth_angles", "ascending, below"),
     "cutter.tooth_angles_deg = 90 deg; allowed: ascending, below 360 deg"},
    {Kind::kNotAllowed, Unit::kMetre, 0.0005, 0, field("process.infeed", "enough for 9 passes"),
     "process.infeed_mm = 0.5 mm; allowed: enough for 9 passes"},
    {Kind::kFeedTooLow, Unit::kFeedMetrePerSecond, 1e-6, 1e-4 / 60,
     [](Reason& r) { r.detail = "axis A velocity", r.x = 0.004; },
     "process.feed_mm_min: axis A velocity allows 0.06 mm/min at X = 4 mm; the slowest feed is 0.1 mm/min"},
    {Kind::kParkInWork, Unit::kMetre, 0.05, 0.0625, ofAxis(kY),
     "park position axis Y = 50 mm; allowed for this job: at least 62.5 mm, clear of the work"},
    {Kind::kTolerance, Unit::kDeviationMetre, 2.5e-6, 1e-6, setpointsOf(kX, 3),
     "interpolation.tolerance_um = 1 um: the path deviates by 2.5 um at the maximum feed override" + kPlace +
         "; lower process.feed_mm_min, or set interpolation.even_step to exact; the worst of 3 setpoints"},
    {Kind::kTooLong, Unit::kSecond, 7200.5, 3600, [](Reason& r) { r.count = 12; },
     "max_job_duration = 3600 s: the job takes 7200.5 s or more for 12 passes of its teeth; raise process.feed_mm_min "
     "or process.infeed_mm, or the parameter"},
    {Kind::kTooLong, Unit::kSecond, 0, 3600, [](Reason& r) { r.count = 1; },
     "max_job_duration = 3600 s: the job takes longer for 1 pass of its teeth; raise process.feed_mm_min or "
     "process.infeed_mm, or the parameter"},
    {Kind::kGivenUp, Unit::kNone, 0, 0, nothing, "given up while it was planned"},
    {Kind::kCollision, Unit::kMetre, 0, 0.001, [](Reason& r) { atStroke(r), r.detail = "wheel and collet"; },
     "collision_clearance = 1 mm: wheel and collet hit each other" + kPlace +
         "; stick the blank out further, and set the zero of X anew"},
    {Kind::kCollision, Unit::kMetre, 0, 0.001, field("", "wheel and shank"),
     "collision_clearance = 1 mm: wheel and shank hit each other; change cutter.shank_diameter_mm, "
     "cutter.neck_length_mm or process.overtravel_mm[1]"},
    {Kind::kCollision, Unit::kMetre, 0, 0.001, field("", "spindle and cutter"),
     "collision_clearance = 1 mm: spindle and cutter hit each other; change process.setup.swivel_deg or "
     "process.wheel.diameter_mm"},
    {Kind::kCollision, Unit::kMetre, 0.0004, 0.001, field("", "spindle and work_head"),
     "collision_clearance = 1 mm: spindle and work_head come within 0.4 mm of each other; stick the blank out further, "
     "and set the zero of X anew"},
    {Kind::kCollision, Unit::kMetre, 0.0001, 0.00025,
     [](Reason& r) { r.field = "process.clearance", r.detail = "wheel and shank", r.low = 0.0005; },
     "process.clearance_mm = 0.5 mm: wheel and shank come within 0.1 mm of each other outside the cut; allowed: 0.25 "
     "mm or more; raise it"},
    {Kind::kSwivel, Unit::kRadian, std::numeric_limits<double>::quiet_NaN(), kPi / 8, swivel(""),
     "process.setup.swivel_deg = 22.5 deg: the swivel is not confirmed; set it to 22.5 deg and confirm it: grind "
     "confirm-swivel 22.5"},
    {Kind::kSwivel, Unit::kRadian, kPi / 6, -kPi / 8, swivel("confirmed"),
     "process.setup.swivel_deg = -22.5 deg: the swivel is confirmed at 30 deg; allowed: within 0.1 deg of that; set it "
     "to -22.5 deg and confirm it: grind confirm-swivel -22.5"},
    {Kind::kSwivel, Unit::kRadian, kPi / 6, kPi / 8, swivel("measured"),
     "process.setup.swivel_deg = 22.5 deg: the swivel is at 30 deg; allowed: within 0.1 deg of that; set it to "
     "22.5 deg"},
    {Kind::kOther, Unit::kNone, 0, 0, field("", "first_tooth = 1"), "first_tooth = 1"},
    {Kind::kPosition, Unit::kMetre, 0.401, 0.3, setpointsOf(kX),
     "axis X machine position 401 mm is 101 mm beyond its limit 300 mm" + kPlace},
    {Kind::kPosition, Unit::kMetre, -0.0225, -0.02, setpointsOf(kY, 2),
     "axis Y machine position -22.5 mm is 2.5 mm beyond its limit -20 mm" + kPlace + "; the worst of 2 setpoints"},
    {Kind::kPosition, Unit::kRadian, kPi, kPi / 2, setpointsOf(kA),
     "axis A machine position 180 deg is 90 deg beyond its limit 90 deg" + kPlace},
    {Kind::kVelocity, Unit::kMetrePerSecond, -0.3, 0.2, setpointsOf(kY),
     "axis Y velocity -300 mm/s is 100 mm/s beyond its limit 200 mm/s" + kPlace},
    {Kind::kVelocity, Unit::kRadianPerSecond, -kPi, kPi / 4, setpointsOf(kA),
     "axis A velocity -180 deg/s is 135 deg/s beyond its limit 45 deg/s" + kPlace},
    {Kind::kAcceleration, Unit::kMetrePerSecond2, 3, 2, setpointsOf(kZ),
     "axis Z acceleration 3000 mm/s^2 is 1000 mm/s^2 beyond its limit 2000 mm/s^2" + kPlace},
    {Kind::kAcceleration, Unit::kRadianPerSecond2, kPi, kPi / 2, setpointsOf(kA),
     "axis A acceleration 180 deg/s^2 is 90 deg/s^2 beyond its limit 90 deg/s^2" + kPlace},
    {Kind::kJerk, Unit::kMetrePerSecond3, 60, 50, setpointsOf(kX),
     "axis X jerk 60000 mm/s^3 is 10000 mm/s^3 beyond its limit 50000 mm/s^3" + kPlace},
    {Kind::kJerk, Unit::kRadianPerSecond3, kPi, kPi / 2, setpointsOf(kA),
     "axis A jerk 180 deg/s^3 is 90 deg/s^3 beyond its limit 90 deg/s^3" + kPlace},
    {Kind::kNotFinite, Unit::kMetre, std::numeric_limits<double>::infinity(), 0.3, setpointsOf(kX),
     "axis X position inf mm is not a finite number" + kPlace},
    {Kind::kEmergencyStop, Unit::kNone, 0, 0, nothing, "emergency stop"},
    {Kind::kEmergencyStop, Unit::kNone, 0, 0, atStroke, "emergency stop" + kPlace},
    {Kind::kDriveFault, Unit::kNone, 0, 0, nothing, "the drive reports a fault"},
    {Kind::kPowerLost, Unit::kNone, 0, 0, nothing, "the drive has switched its power off"},
    {Kind::kStaleFeedback, Unit::kSecond, 0.06, 0.05, nothing,
     "no fresh positions from the drive for 0.06 s, allowed 0.05 s"},
    {Kind::kInvalidFeedback, Unit::kMetre, std::numeric_limits<double>::infinity(), 0, ofAxis(kZ),
     "axis Z position from the drive is inf"},
    {Kind::kFollowingError, Unit::kMetre, 0.0012, 0.001, ofAxis(kX),
     "axis X following error 1.2 mm is beyond its limit 1 mm"},
    {Kind::kUnderrun, Unit::kNone, 3, 0, [](Reason& r) { r.cycle = 77; },
     "the axes found no setpoint in 3 servo cycles, after setpoint 77"},
    {Kind::kLate, Unit::kSecond, 0.052, 0.01, nothing,
     "the control loop came 0.052 s after the cycle before, allowed 0.01 s"},
    {Kind::kSlow, Unit::kSecond, 0.002, 0.0016, nothing,
     "the control loop takes 0.002 s for a cycle on average, allowed 0.0016 s"},
    {Kind::kHoming, Unit::kSecond, 30.001, 30, nothing,
     "the drive has not found its reference after 30.001 s, allowed 30 s"},
    {Kind::kInterlock, Unit::kSecond, 10.5, 10, field("", "no coolant flows"),
     "no coolant flows 10.5 s after the job was started, allowed 10 s"},
    {Kind::kRake, Unit::kRadian, 0.25 * kPi, kPi / 18, ofThirdTooth(kPi / 360),
     "cutter.rake_angle_deg = 10 deg: tooth 3 is ground with 45 deg at X = 12.3 mm; allowed: within 0.5 deg of it; "
     "change process.setup.swivel_deg or process.setup.height_mm"},
    {Kind::kSpiral, Unit::kRadian, 0.25 * kPi, kPi / 6, ofThirdTooth(kPi / 360),
     "cutter.spiral_angle_deg = 30 deg: the edge of tooth 3 is ground with 45 deg at X = 12.3 mm; allowed: within 0.5 "
     "deg of it; change process.setup.x_shift_mm"},
    {Kind::kChordalRake, Unit::kRadian, 0.25 * kPi, kPi / 18, ofThirdTooth(kPi / 36),
     "cutter.rake_angle_deg = 10 deg: tooth 3 has a chordal rake of 45 deg at X = 12.3 mm; allowed: within 5 deg of "
     "it; change process.wheel.diameter_mm or process.wheel.width_mm"},
    {Kind::kClearance, Unit::kRadian, kPi / 20, kPi / 18, ofThirdTooth(kPi / 360),
     "cutter.clearance_deg = 10 deg: tooth 3 is ground with 9 deg at X = 12.3 mm; allowed: within 0.5 deg of it; "
     "change the height or the swivel of the relief's set-up"},
    {Kind::kEnd, Unit::kRadian, kPi / 20, kPi / 18,
     [](Reason& r) { ofThirdTooth(kPi / 360)(r), r.detail = "gash rake"; },
     "the gash rake of tooth 3 is 9 deg, 12.3 mm from the axis; allowed: within 0.5 deg of 10 deg"},
    {Kind::kUndercut, Unit::kMetre, 9.98e-3, 10e-3, ofThirdTooth(6e-6),
     "the relief leaves tooth 3 an edge diameter of 9.98 mm at X = 12.3 mm; allowed: within 0.006 mm of 10 mm; grind "
     "the flutes with an edge nearer to the asked helix"},
    {Kind::kNextEdge, Unit::kRadian, kPi / 60, 0, ofThirdTooth(),
     "the relief's wheel reaches 3 deg into the tooth behind tooth 3 at X = 12.3 mm; change the height of the relief's "
     "set-up, or take a narrower wheel"},
    {Kind::kSecondClearance, Unit::kRadian, kPi / 10, kPi / 9, ofThirdTooth(kPi / 360),
     "cutter.second_clearance_deg = 20 deg: tooth 3 is ground with 18 deg at X = 12.3 mm; allowed: within 0.5 deg of "
     "it; "
     "change the height or the swivel of the relief's set-up, or take a wheel with smaller corner radii"},
    {Kind::kPrimaryLand, Unit::kMetre, 0.3e-3, 0.4e-3, ofThirdTooth(0.02e-3),
     "cutter.land_mm = 0.4 mm there: the primary relief of tooth 3 is left 0.3 mm wide at X = 12.3 mm; allowed: within "
     "0.02 mm of it; change the set-up of the secondary relief"},
    {Kind::kHeel, Unit::kMetre, 0, 0, ofThirdTooth(),
     "the relief of tooth 3 ends on the land at X = 12.3 mm; change the height of the relief's set-up, or take a wider "
     "wheel"},
    {Kind::kCoreSize, Unit::kMetre, 0.00713, 0.0068, [](Reason& r) { r.low = 2e-5; },
     "cutter.core_diameter_mm, cutter.core_diameter_end_mm: the core is 7.13 mm at X = 0 mm; allowed: within 0.02 mm "
     "of 6.8 mm; change process.depth_mm or process.depth_end_mm"},
    {Kind::kCoreSize, Unit::kMetre, 0.00663, 0.0068, [](Reason& r) { r.low = 2e-5, r.detail = "the height"; },
     "cutter.core_diameter_mm, cutter.core_diameter_end_mm: the core is 6.63 mm at X = 0 mm; allowed: within 0.02 mm "
     "of 6.8 mm; change the height"},
    {Kind::kLand, Unit::kRadian, 0.75 * kPi, 0.5 * kPi, [](Reason& r) { r.x = 0.0123; },
     "no land is left on tooth 1 at X = 12.3 mm: its flute takes 135 deg, its pitch is 90 deg; lower "
     "process.wheel.width_mm or process.depth_mm"},
    {Kind::kCore, Unit::kMetre, 0, 0, [](Reason& r) { r.x = 0.0123; },
     "process.depth_mm: the core is cut through at X = 12.3 mm; lower it"},
    {Kind::kIncomplete, Unit::kMetre, 0.025, 0.03, [](Reason& r) { r.low = 0.002; },
     "process.overtravel_mm[0], process.overtravel_mm[1]: the flutes are complete from X = 2 mm to 25 mm; allowed: "
     "over the whole flute length, 0 to 30 mm, unless process.incomplete_ok is true"},
    {Kind::kIncomplete, Unit::kMetre, 0, 0.03, nothing,
     "process.overtravel_mm[0], process.overtravel_mm[1]: the flutes are complete nowhere; allowed: over the whole "
     "flute length, 0 to 30 mm, unless process.incomplete_ok is true"},
    {Kind::kUnevenRake, Unit::kRadian, kPi / 4, kPi / 18, [](Reason& r) { r.low = kPi / 36, r.tooth = 1; },
     "process.z_law = constant_rake: tooth 2 is ground with 5 deg to 45 deg at best, asked 10 deg; allowed: within "
     "0.005 deg of it; change process.setup.swivel_deg or process.setup.height_mm, or raise process.overtravel_mm[0] "
     "or process.overtravel_mm[1]"},
    {Kind::kUnevenRake, Unit::kRadian, 0, kPi / 18, [](Reason& r) { r.low = 1; },
     "process.z_law = constant_rake: tooth 1 has no rake face over its whole flute; change process.setup.swivel_deg or "
     "process.setup.height_mm, or raise process.overtravel_mm[0] or process.overtravel_mm[1]"},
    {Kind::kCanceled, Unit::kNone, 0, 0, atStroke, "canceled; stopped on the path" + kPlace},
};

TEST(Reason, OfEveryKindHasTheTextByHand) {
  std::set<Kind> kinds;
  for (const Row& row : kRows) {
    Reason reason;
    reason.kind = row.kind;
    reason.unit = row.unit;
    reason.value = row.value;
    reason.limit = row.limit;
    row.change(reason);
    EXPECT_EQ(text(reason), row.text);
    kinds.insert(row.kind);
  }
  EXPECT_EQ(kinds.size(), static_cast<std::size_t>(kReasonKindCount));
}

TEST(Reason, OfEveryFaultHasText) {
  for (int kind = 1; kind < countOf<FaultKind>(); ++kind) {
    LoopFault fault;
    fault.kind = static_cast<FaultKind>(kind);
    fault.interlock = Interlock::kSpindle;
    EXPECT_NE(fault.text(), "") << kind;
  }
  EXPECT_EQ(LoopFault().text(), "");
  LoopFault underrun;
  underrun.kind = FaultKind::kUnderrun;
  underrun.value = 3;
  underrun.cycle = 77;
  EXPECT_EQ(underrun.text(), "the axes found no setpoint in 3 servo cycles, after setpoint 77");
}

TEST(Reason, OfAViolationInTheLoopHasItsPlace) {
  LoopFault fault;
  fault.kind = FaultKind::kLimit;
  fault.violation = {kA, LimitedQuantity::kVelocity, -kPi, kPi / 2, 8, 0.03, MoveKind::kIndex, 2, 4};
  EXPECT_EQ(text(reasonOf(fault)),
            "axis A velocity -180 deg/s is 90 deg/s beyond its limit 90 deg/s (index, tooth 3, pass 5, X = 30 mm)");
}

TEST(Reason, CutsNothingOff) {
  const std::string name(100000, 'n');
  EXPECT_EQ(format("<%s>", name.c_str()), "<" + name + ">");
  EXPECT_EQ(format("%s", ""), "");
}

TEST(Reason, ManyStandSideBySide) {
  Reason stop, other;
  stop.kind = Kind::kEmergencyStop;
  other.kind = Kind::kOther;
  other.detail = "busy";
  EXPECT_EQ(text(std::vector<Reason>{stop, other}), "emergency stop; busy");
}

}  // namespace test_reason
}  // namespace grinder
