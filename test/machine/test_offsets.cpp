#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/machine/machine_geometry.h"
#include "flute_grinder/machine/offset_fit.h"
#include "flute_grinder/machine/offset_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

/// @file
/// Which work offsets fit which job, and which are too large. Where the wheel's centre must be is computed from the
/// machine's geometry.

namespace grinder {
namespace test_offsets {

const double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = 0.017453292519943295;

/// A job of D 6 with a wheel of D 100 x 3.
OffsetBasis basisOf(OffsetMethod method = OffsetMethod::kTouchOff) {
  return {method, "d6.yaml",    "a.yaml", std::string(64, 'a'), 0.006, 0.1, 0.003,
          0,      30 * kDegree, 0.0015,   std::string(64, 'c')};
}

OffsetBasis basisOfNoJob(OffsetMethod method) {
  OffsetBasis basis;
  basis.method = method;
  return basis;
}

WorkOffset offsetFor(const OffsetBasis& basis) { return {0.001, "anna@grinder", 1.7e9, basis}; }

/// All set for a job, A never; its wheel is mounted.
WorkOffsets offsetsFor(const OffsetBasis& basis) {
  WorkOffsets offsets;
  offsets.wheel = {basis.wheel_name, basis.wheel_digest, basis.wheel_diameter};
  for (const int axis : {kX, kY, kZ}) offsets.axes[static_cast<std::size_t>(axis)] = offsetFor(basis);
  return offsets;
}

/// The axes that do not fit.
std::string axesOf(const std::vector<OffsetMismatch>& mismatches) {
  std::string axes;
  for (const OffsetMismatch& mismatch : mismatches) {
    if (mismatch.what != "wheel") axes += mismatch.what;
  }
  return axes;
}

std::vector<std::string> reasonsOf(const std::vector<OffsetMismatch>& mismatches) {
  std::vector<std::string> reasons;
  for (const OffsetMismatch& mismatch : mismatches) reasons.push_back(mismatch.reason);
  return reasons;
}

TEST(OffsetFit, WhatWasSetForTheJobFitsAndAFitsTheFlutes) {
  const OffsetBasis job = basisOf();
  EXPECT_TRUE(mismatches(offsetsFor(job), job).empty());
  WorkOffsets offsets = offsetsFor(job);
  offsets.axes[kA] = offsetFor(OffsetBasis{});
  EXPECT_TRUE(mismatches(offsets, job).empty());
}

TEST(OffsetFit, OnlyWhatFitsIsCorrected) {
  const OffsetBasis job = basisOf();
  WorkOffsets offsets = offsetsFor(job);
  EXPECT_EQ(correctionRefusal(offsets, kY, job), "");
  OffsetBasis other = job;
  other.end_diameter = 0.008;
  EXPECT_NE(correctionRefusal(offsets, kY, other).find("; this job has D 8 mm: it cannot be corrected"),
            std::string::npos);
  EXPECT_EQ(correctionRefusal(offsets, kZ, other), "");
  ++offsets.wheel.mounting;
  EXPECT_NE(correctionRefusal(offsets, kZ, job).find("another wheel has been mounted since"), std::string::npos);
  offsets.axes[kZ] = {};
  EXPECT_EQ(correctionRefusal(offsets, kZ, job), "Z was never set: it cannot be corrected; touch it off");
}

TEST(OffsetFit, WhatIsNotKnownDoesNotFitAndIsNotComputed) {
  WorkOffsets unreadable;
  unreadable.axes[kX].value = kNan;
  const struct {
    WorkOffsets offsets;
    std::vector<std::string> reasons;
  } rows[]{{{}, {"X was never set", "Y was never set", "Z was never set"}},
           {unreadable, {"X cannot be read", "Y was never set", "Z was never set"}},
           // Set before this was kept.
           {offsetsFor(OffsetBasis{}),
            {"X was set, not known for which job", "Y was set, not known for which job",
             "Z was set, not known for which job"}},
           // X depends on no job.
           {offsetsFor(basisOfNoJob(OffsetMethod::kTouchOff)),
            {"Y was touched off, not known for which job", "Z was touched off, not known for which job"}}};
  for (const auto& row : rows) {
    WorkOffsets offsets = row.offsets;
    offsets.wheel = offsetsFor(basisOf()).wheel;
    const auto found = mismatches(offsets, basisOf());
    for (const OffsetMismatch& mismatch : found) EXPECT_FALSE(mismatch.change) << mismatch.reason;
    EXPECT_EQ(reasonsOf(found), row.reasons);
  }
}

// Where X does not fit, the wheel is another or stands elsewhere: nothing can be computed from the figures.
TEST(OffsetFit, EveryFigureCountsForItsAxesAlone) {
  const struct {
    const char* axes;
    const char* has;
    void (*change)(OffsetBasis&);
  } rows[]{
      {"Y", "D 6.001 mm", [](OffsetBasis& b) { b.end_diameter += 1e-6; }},
      {"Z", "height -1.5 mm", [](OffsetBasis& b) { b.height *= -1; }},
      {"XZ", "swivel 30.06 deg", [](OffsetBasis& b) { b.swivel += 0.06 * kDegree; }},
      {"XZ", "width of the wheel 2.9 mm", [](OffsetBasis& b) { b.wheel_width -= 1e-4; }},
      {"XYZ", "another wheel a.yaml, D 100 mm", [](OffsetBasis& b) { b.wheel_digest[63] = 'b'; }},
      {"XYZ", "wheel b.yaml, D 100 mm", [](OffsetBasis& b) { b.wheel_name = "b.yaml", b.wheel_width = 0.002; }},
      {"Y", "D nan mm", [](OffsetBasis& b) { b.end_diameter = kNan; }},
      {"Z", "height nan mm", [](OffsetBasis& b) { b.height = kNan; }},
      {"XZ", "swivel nan deg", [](OffsetBasis& b) { b.swivel = kNan; }},
      {"", "", [](OffsetBasis& b) { b.job_name = "other.yaml"; }},
      {"XYZ", "wheel D 100 mm", [](OffsetBasis& b) { b.wheel_name = ""; }},
      {"", "", [](OffsetBasis& b) { b.swivel += 0.04 * kDegree; }},
      {"", "", [](OffsetBasis& b) { b.end_diameter += 1e-12; }},
  };
  for (const auto& row : rows) {
    OffsetBasis job = basisOf();
    row.change(job);
    const auto found = mismatches(offsetsFor(basisOf()), job);
    EXPECT_EQ(axesOf(found), row.axes) << row.has;
    for (const auto& mismatch : found) {
      if (mismatch.what == "wheel") continue;
      EXPECT_EQ(mismatch.reason.substr(mismatch.reason.find("; ")), std::string("; this job has ") + row.has);
      if (row.axes[0] == 'X') {
        EXPECT_FALSE(mismatch.change) << row.has;
      }
      if (row.axes == std::string("Y")) {
        EXPECT_EQ(mismatch.reason.find("Y was touched off for D 6 mm, wheel a.yaml, D 100 mm (d6.yaml); "), 0U);
      }
    }
  }
}

/// Whatever the machine, and wherever its wheel is mounted.
TEST(OffsetFit, WhatIsComputedIsWhereTheGeometryHasTheZeroPoints) {
  std::mt19937 random(1);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int n = 0; n < 200; ++n) {
    MachineGeometry machine;
    machine.work_axis_y = between(-0.1, 0.1);
    machine.work_axis_z = between(-0.1, 0.1);
    machine.collet_face = between(-0.1, 0.1);
    machine.swivel_centre = {between(-0.1, 0.1), between(-0.1, 0.1), between(-0.1, 0.1)};
    machine.flange = between(-0.05, 0.05);
    const Mounting mounting{between(-0.01, 0.01), between(0.01, 0.1)};
    GrindJob was;
    was.cutter.end_diameter = between(0.0001, 0.1);
    was.process().wheel_diameter = between(0.01, 0.5);
    was.process().wheel_width = between(0.001, 0.1);
    was.process().setup_swivel = between(-1, 1);
    was.process().setup_height = between(-0.05, 0.05);
    GrindJob is = was;
    is.cutter.end_diameter = between(0.0001, 0.1);
    is.process().setup_height = between(-0.05, 0.05);
    const auto basis = [](const GrindJob& job) {
      OffsetBasis basis = basisOf(OffsetMethod::kComputed);
      basis.end_diameter = job.cutter.end_diameter;
      basis.wheel_diameter = job.process().wheel_diameter;
      basis.wheel_width = job.process().wheel_width;
      basis.swivel = job.process().setup_swivel;
      basis.height = job.process().setup_height;
      return basis;
    };
    WorkOffsets offsets = offsetsFor(basis(was));
    const Eigen::Vector3d before = workZero(machine, was, mounting), after = workZero(machine, is, mounting);
    for (int axis = kX; axis <= kZ; ++axis) offsets.axes[static_cast<std::size_t>(axis)].value = before[axis];
    const auto found = mismatches(offsets, basis(is));
    ASSERT_EQ(axesOf(found), "YZ");
    for (const auto& mismatch : found) {
      ASSERT_TRUE(mismatch.change);
      EXPECT_NEAR(before[mismatch.axis] + *mismatch.change, after[mismatch.axis], 1e-15);
    }
    EXPECT_NEAR(before.x(), after.x(), 1e-15);
  }
}

TEST(OffsetFit, TheWheelOnTheSpindleIsThatOfTheJob) {
  const OffsetBasis job = basisOf();
  WorkOffsets offsets = offsetsFor(job);
  const std::string remedy = "; this job has a.yaml, D 100 mm";
  offsets.wheel = {};
  EXPECT_EQ(reasonsOf(mismatches(offsets, job)),
            std::vector<std::string>{"the wheel on the spindle is not confirmed" + remedy});
  offsets.wheel = {"b.yaml", job.wheel_digest, 0.1};
  EXPECT_EQ(reasonsOf(mismatches(offsets, job)),
            std::vector<std::string>{"the wheel on the spindle is b.yaml, D 100 mm" + remedy});
  offsets.wheel = {job.wheel_name, std::string(64, 'b'), 0.1};
  EXPECT_EQ(mismatches(offsets, job).size(), 1U) << "of other figures";
}

TEST(OffsetFit, TheWheelIsOneNeedAndTheOffsetsAreAnother) {
  OffsetBasis job = basisOf();
  const WorkOffsets offsets = offsetsFor(job);
  EXPECT_TRUE(needsOf(mismatches(offsets, job)).empty());
  job.end_diameter += 0.004;
  std::vector<Need> needs = needsOf(mismatches(offsets, job));
  ASSERT_EQ(needs.size(), 1U);
  EXPECT_EQ(needs[0].kind, NeedKind::kOffsets);
  EXPECT_EQ(needs[0].answers, (std::vector{NeedAnswer::kFitOffsets, NeedAnswer::kIgnoreOffsets}));
  ASSERT_EQ(needs[0].figures.size(), 1U);
  EXPECT_EQ(needs[0].figures[0].what + " " + needs[0].figures[0].difference, "Y 2 mm");
  job.height += 0.001;
  const std::vector<std::string> reasons = reasonsOf(mismatches(offsets, job));
  ASSERT_EQ(reasons.size(), 2U);
  EXPECT_EQ(needsOf(mismatches(offsets, job))[0].text, reasons[0] + "; " + reasons[1]);
  job.wheel_name = "b.yaml";
  needs = needsOf(mismatches(offsets, job));
  ASSERT_EQ(needs.size(), 2U);
  EXPECT_EQ(needs[0].kind, NeedKind::kWheel);
  EXPECT_EQ(needs[0].answers, std::vector{NeedAnswer::kConfirmWheel});
  EXPECT_EQ(needs[1].answers, std::vector{NeedAnswer::kIgnoreOffsets}) << "those of another wheel cannot be computed";
}

TEST(OffsetFit, WhatWasSetWithAWheelDoesNotFitOnceAnotherWasOnTheSpindle) {
  WorkOffsets offsets = offsetsFor(basisOf());
  offsets.axes[kX].basis = basisOfNoJob(OffsetMethod::kTouchOff);
  ++offsets.wheel.mounting;
  offsets.axes[kZ].mounting = offsets.wheel.mounting;
  const auto found = mismatches(offsets, basisOf());
  ASSERT_EQ(axesOf(found), "XY");
  for (const OffsetMismatch& mismatch : found) {
    EXPECT_FALSE(mismatch.change);
    EXPECT_NE(mismatch.reason.find("; another wheel has been mounted since"), std::string::npos) << mismatch.reason;
  }
}

TEST(OffsetFit, AReliefWantsAAsItsOperationsBeforeHaveLeftIt) {
  OffsetBasis primary = basisOf(), secondary = basisOf();
  primary.kind = secondary.before = OperationKind::kPrimaryRelief;
  secondary.kind = OperationKind::kSecondaryRelief;
  const auto refusalOf = [](const WorkOffsets& offsets, const OffsetBasis& job) {
    const auto found = mismatches(offsets, job);
    EXPECT_LE(found.size(), 1U);
    return found.empty() ? "" : found[0].reason;
  };
  WorkOffsets offsets = offsetsFor(primary);
  const auto is = [&](const std::string& tool, std::uint32_t ground) {
    offsets.tool = {tool, "d6.yaml", ground, TeethUnknown::kNeverGround, 0};
  };
  const std::string remedy = "; probe a tooth: grind probe tooth",
                    unknown = "A: where the teeth of this tool are is not known: ";
  EXPECT_EQ(refusalOf(offsets, basisOf()), "") << "flutes may be anywhere on a blank";
  EXPECT_EQ(refusalOf(offsets, primary), unknown + "no flutes were ground" + remedy);
  for (const auto& [why, said] : {std::pair(TeethUnknown::kClamped, "the tool was clamped anew"),
                                  std::pair(TeethUnknown::kHomed, "the axes were homed after the flutes"),
                                  std::pair(TeethUnknown::kSet, "the zero point of A was set after the flutes")}) {
    is(primary.tool_digest, 0b1);
    EXPECT_EQ(refusalOf(offsets, primary), "");
    offsets.tool.forget(why);
    EXPECT_EQ(refusalOf(offsets, primary), unknown + said + remedy);
    EXPECT_EQ(refusalOf(offsets, basisOf()), "");
  }
  OffsetBasis nameless = primary;
  nameless.tool_digest = "";
  EXPECT_EQ(refusalOf(offsets, nameless), refusalOf(offsets, primary)) << "two unknown tools are not the same";
  is(std::string(64, 'd'), 0b1);
  EXPECT_EQ(refusalOf(offsets, primary), unknown + "A is as for d6.yaml with flute" + remedy);
  is(primary.tool_digest, 0);
  EXPECT_EQ(refusalOf(offsets, primary), "A: operation flute is not ground on this tool");
  is(primary.tool_digest, 0b1);
  EXPECT_EQ(refusalOf(offsets, secondary), "A: operation primary relief is not ground on this tool");
  is(primary.tool_digest, 0b11);
  EXPECT_EQ(refusalOf(offsets, secondary), "");
  const std::string twice = " is ground on this tool already; if another blank is clamped, say so: grind reclamped";
  EXPECT_EQ(refusalOf(offsets, primary), "A: operation primary relief" + twice);
  EXPECT_EQ(refusalOf(offsets, basisOf()), "A: operation flute" + twice);
  OffsetBasis none = basisOf();
  none.kind = none.before = static_cast<OperationKind>(255);
  EXPECT_NE(refusalOf(offsets, none), "") << "a message may have one that there is not";
  // A tooth of a tool whose flutes were ground elsewhere.
  is(primary.tool_digest, 0);
  offsets.axes[kA] = offsetFor(basisOf(OffsetMethod::kProbe));
  EXPECT_EQ(refusalOf(offsets, primary), "");
  EXPECT_EQ(refusalOf(offsets, secondary), "");
}

TEST(OffsetFit, AnOperationFollowsTheOneBeforeItInTheListWhateverKindsAreLeftOut) {
  OffsetBasis gash = basisOf(), end = basisOf();
  gash.kind = end.before = OperationKind::kGash;
  end.kind = OperationKind::kPrimaryEnd;
  WorkOffsets offsets = offsetsFor(gash);
  const auto reasons = [&](const OffsetBasis& job) { return reasonsOf(mismatches(offsets, job)); };
  offsets.tool = {gash.tool_digest, "d6.yaml", 0b1, TeethUnknown::kNeverGround, 0};
  EXPECT_EQ(reasons(gash), std::vector<std::string>{});
  EXPECT_EQ(reasons(end), std::vector<std::string>{"A: operation gash is not ground on this tool"});
  offsets.tool.ground |= ClampedTool::bitOf(gash.kind);
  EXPECT_EQ(offsets.tool.ground, 0b1001U);
  EXPECT_EQ(toolText(offsets.tool), "d6.yaml with flute, gash");
  EXPECT_EQ(reasons(end), std::vector<std::string>{});
  ASSERT_EQ(reasons(gash).size(), 1U);
  EXPECT_EQ(reasons(gash)[0].rfind("A: operation gash is ground on this tool already", 0), 0U);
}

TEST(OffsetFit, ShowsWhatAnOffsetWasSetFor) {
  const OffsetBasis none = basisOfNoJob(OffsetMethod::kByHand);
  WorkOffset unknown;
  unknown.value = kNan;
  const struct {
    int axis;
    WorkOffset offset;
    const char* text;
  } rows[]{{kY, {}, "never set"},
           {kY, unknown, "cannot be read"},
           {kX, offsetFor(basisOf(OffsetMethod::kProbe)),
            "probed for swivel 30 deg, wheel a.yaml, D 100 mm, width of the wheel 3 mm (d6.yaml)"},
           {kA, offsetFor(basisOf()), "touched off (d6.yaml)"},
           {kX, offsetFor(none), "set by hand"},
           {kZ, offsetFor(none), "set by hand, not known for which job"}};
  for (const auto& row : rows) EXPECT_EQ(basisText(row.axis, row.offset), row.text);
}

const double kInf = std::numeric_limits<double>::infinity();
const double kTurn = 2 * std::acos(-1.0);

OffsetLimits limitsOf(double a) {
  AxisLimits travel;
  travel.min_position << -0.1, -0.02, -0.05, -a;
  travel.max_position << 0.3, 0.15, 0.1, a;
  return offsetLimits(travel, {0.005, 0.005, 0.005, kTurn});
}

TEST(OffsetLimits, AreTheTravelAndOfAOneTurnMoreAndAnyOffsetIfItTurnsForEver) {
  const OffsetLimits limits = limitsOf(1), for_ever = limitsOf(kInf);
  EXPECT_EQ(travelRefusal(limits, kY, 0.1501),
            "work offset of axis Y = 150.1 mm; allowed: -20 to 150 mm, the travel of the axis");
  const struct {
    const OffsetLimits& limits;
    int axis;
    std::vector<double> good, wrong;
  } rows[]{{limits, kY, {-0.02, 0.0, 0.15}, {-0.0201, 6.203, 1000.0, kNan, kInf, -kInf}},
           {limits, kA, {1 + kTurn, -1 - kTurn}, {1.001 + kTurn, -1.001 - kTurn}},
           {for_ever, kA, {kMaxOffset}, {kMaxOffset * 1.001, kNan}}};
  for (const auto& row : rows) {
    for (const double good : row.good) EXPECT_EQ(travelRefusal(row.limits, row.axis, good), "");
    for (const double wrong : row.wrong) EXPECT_NE(travelRefusal(row.limits, row.axis, wrong), "");
  }
}

TEST(OffsetLimits, ALargeChangeOfOneThatWasSetWantsAConfirmation) {
  const OffsetLimits limits = limitsOf(100);
  WorkOffsets was;
  for (const int axis : {kY, kZ, kA}) was.axes[static_cast<std::size_t>(axis)] = {0.0015, "anna@grinder", 1.7e9};
  const auto need = needOfChange(limits, was, {{kY, -0.0105}});
  ASSERT_TRUE(need);
  EXPECT_EQ(need->text,
            "work offset of axis Y would change by 12 mm, from 1.5 mm to -10.5 mm; allowed without an answer: 5 mm");
  EXPECT_EQ(need->figures[0].difference, "-12 mm");
  const auto of_several = needOfChange(limits, was, {{kY, -0.0105}, {kZ, 0.002}, {kA, 7}});
  ASSERT_TRUE(of_several);
  EXPECT_EQ(of_several->text.find(need->text + "; work offset of axis A would change by "), 0U) << of_several->text;
  EXPECT_EQ(of_several->figures.size(), 2U) << "of Z it is small";
  EXPECT_NE(answerId(*of_several, NeedAnswer::kSetOffset), answerId(*need, NeedAnswer::kSetOffset));
  EXPECT_FALSE(needOfChange(limits, was, {{kY, 0.006}}));
  EXPECT_TRUE(needOfChange(limits, was, {{kY, kNan}}));
  EXPECT_FALSE(needOfChange(limits, was, {{kA, 6}}));
  EXPECT_TRUE(needOfChange(limits, was, {{kA, 7}}));
  EXPECT_FALSE(needOfChange(limits, WorkOffsets{}, {{kY, 0.1}})) << "never set";
  was.axes[kY].value = kNan;
  EXPECT_FALSE(needOfChange(limits, was, {{kY, 0.1}})) << "unknown";
}

}  // namespace test_offsets
}  // namespace grinder
