// The set-up of an operation on a tool's end, against the closed forms of its plane.

#include "flute_grinder/base/units.h"
#include "flute_grinder/setup/job_setup.h"
#include "flute_grinder/setup/setup_sheet.h"
#include "flute_grinder/setup/touch_off.h"
#include "flute_grinder/tool/z_law.h"

#include "jobs.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grinder {
namespace test_straight_setup {

using units::kDegree;
using units::kMillimetre;

constexpr Range kMachine{-90 * kDegree, 90 * kDegree};
constexpr double kRadius = 5 * kMillimetre, kWheelRadius = 50 * kMillimetre, kWidth = 10 * kMillimetre;
constexpr double kLengthRounding = 5.1e-6 * kMillimetre, kAngleRounding = 0.51e-4 * kDegree;
constexpr OperationKind kKinds[] = {OperationKind::kGash, OperationKind::kPrimaryEnd, OperationKind::kSecondaryEnd,
                                    OperationKind::kChamfer};

/// An operation on the end of the shipped end mill of 10 mm with straight flutes and teeth.
GrindJob endJob(OperationKind kind, int teeth = 4) {
  GrindJob job = test_support::jobOf("roughing_d10_t4");
  CutterGeometry& c = job.cutter;
  c.spiral_angle = c.rake_angle = 0;
  c.end_clearance = 8 * kDegree;
  c.end_second_clearance = 18 * kDegree;
  c.end_land = 0.4 * kMillimetre;
  c.end_dish = 2 * kDegree;
  c.end_rake = 3 * kDegree;
  c.end_clearance_tolerance = c.end_rake_tolerance = 0.5 * kDegree;
  c.chamfer_width = 0.2 * kMillimetre;
  c.chamfer_angle = 45 * kDegree;
  c.chamfer_clearance = 10 * kDegree;
  job.tooth_angles.clear();
  for (int i = 0; i < teeth; ++i) job.tooth_angles.push_back(i * units::kTurn / teeth);
  job.operations.push_back(job.process());
  job.operation = 1;
  clearSetup(job);
  GrindProcess& p = job.process();
  p.kind = kind;
  p.depth = p.overtravel_end = 0;
  p.infeed = 0.2 * kMillimetre, p.finish_infeed = 0.03 * kMillimetre, p.spark_out = 1;
  p.clearance = 1 * kMillimetre;
  p.stock = 0.1 * kMillimetre;
  p.wheel_diameter = 2 * kWheelRadius, p.wheel_width = kWidth, p.wheel_wear_per_pass = 0;
  if (kind == OperationKind::kGash) {
    p.gash_angle = 45 * kDegree, p.gash_past = -0.15 * kMillimetre, p.infeed = 2 * kMillimetre;
  }
  return job;
}

GrindJob leftHand(GrindJob job) {
  job.cutter.cut = CutDirection::kLeftHand;
  return job;
}

JobSetup solved(const GrindJob& job) {
  const auto result = solveJobSetup(job, kMachine, std::nullopt);
  if (const auto* refusal = std::get_if<std::string>(&result)) {
    ADD_FAILURE() << *refusal;
    return {};
  }
  return std::get<JobSetup>(result);
}

std::string refused(const GrindJob& job, const Range& machine, std::optional<SetupFigure> keep = std::nullopt) {
  const auto result = solveJobSetup(job, machine, keep);
  const auto* refusal = std::get_if<std::string>(&result);
  return refusal ? *refusal : "";
}

std::vector<double> zOfTeeth(const ValidJob& job) {
  std::vector<double> z;
  for (int i = 0; i < job.teeth(); ++i) z.push_back(job.faceStroke(i, job.deepest(), 0).to[kZ]);
  return z;
}

TEST(StraightSetup, HasTheSwivelOfThePlaneAndZeroAtTheEnd) {
  const double swivels[] = {3.000, 81.76003, 71.90308, 44.13603};
  for (const OperationKind kind : kKinds) {
    SCOPED_TRACE(toString(kind));
    const JobSetup setup = solved(endJob(kind));
    const double swivel = swivels[static_cast<int>(kind) - static_cast<int>(OperationKind::kGash)] * kDegree;
    EXPECT_NEAR(setup.job.process().setup_swivel, swivel, kAngleRounding);
    EXPECT_NEAR(std::remainder(setup.job.process().setup_swivel, 1e-4 * kDegree), 0, 1e-12);  // as in a file
    const ValidJob job = withLaws(ValidJob(setup.job));
    for (const double z : zOfTeeth(job)) EXPECT_NEAR(z, 0, kLengthRounding);
    EXPECT_EQ(setup.straight.value().last.to[kZ], zOfTeeth(job)[0]);
  }
}

// The figures of another computation, for which only the next tooth's edge is in the way.
TEST(StraightSetup, SaysHowFarYGoes) {
  struct Row {
    OperationKind kind;
    int teeth;
    double y, face;  // [mm]
  };
  for (const auto& [kind, teeth, y, face] :
       {Row{OperationKind::kPrimaryEnd, 3, -6.90, 13.8}, Row{OperationKind::kPrimaryEnd, 4, -6.43, -12.1},
        Row{OperationKind::kSecondaryEnd, 4, -5.24, -5.3}}) {
    const JobSetup setup = solved(endJob(kind, teeth));
    const GrindProcess& p = setup.job.process();
    const JobSetup::Straight& straight = setup.straight.value();
    EXPECT_NEAR(straight.last.to[kY] / kMillimetre, y, 0.05) << teeth;
    EXPECT_NEAR(straight.past_axis, -straight.last.to[kY] - kRadius, 1e-12);
    EXPECT_NEAR((p.setup_height - kWidth / 2 * std::cos(p.setup_swivel)) / kMillimetre, face, 0.5);
  }
  const JobSetup gash = solved(endJob(OperationKind::kGash));
  const double y = 0.15 * kMillimetre - kRadius - kWheelRadius * (1 - std::cos(45 * kDegree));
  EXPECT_NEAR(gash.straight.value().last.to[kY], y, 1e-9);
}

TEST(StraightSetup, CountsPassesAndTravel) {
  const JobSetup setup = solved(endJob(OperationKind::kPrimaryEnd));
  const JobSetup::Straight& straight = setup.straight.value();
  const double dish = std::tan(2 * kDegree), clearance = std::tan(8 * kDegree);
  const double stock =
      (0.1 * kMillimetre + kRadius * (dish + clearance)) / std::sqrt(1 + dish * dish + clearance * clearance);
  EXPECT_NEAR(straight.stock, stock, 1e-12);
  const int rough = static_cast<int>(std::ceil((stock - 0.03 * kMillimetre) / (0.2 * kMillimetre)));
  EXPECT_EQ(straight.passes, rough + 2);
  EXPECT_NEAR(straight.travel[kX], (stock - 0.2 * kMillimetre) / std::sin(setup.job.process().setup_swivel), 1e-9);
  EXPECT_NEAR(straight.travel[kY], 1 * kMillimetre - straight.last.to[kY], 1e-12);
  EXPECT_EQ(straight.travel[kZ], 0);
  const ValidJob ground = withLaws(ValidJob(setup.job));  // with where the flutes have their edges
  const double first = ground.edges()[0].at_end;
  EXPECT_NEAR(straight.travel[kA], 270 * kDegree + ground.edges()[3].at_end - first, 1e-12);
  EXPECT_NEAR(straight.last.to[kA], first + std::atan(dish / clearance), 1e-12);

  const JobSetup gash = solved(endJob(OperationKind::kGash));
  EXPECT_NEAR(gash.straight.value().stock, kRadius - 0.05 * kMillimetre, 1e-12);
  EXPECT_EQ(gash.straight.value().passes, 5);
}

TEST(StraightSetup, OfUnequalTeethHasZeroInTheMiddle) {
  GrindJob job = endJob(OperationKind::kPrimaryEnd);
  job.tooth_angles = {0, 80 * kDegree, 180 * kDegree, 260 * kDegree};
  const std::vector<double> z = zOfTeeth(withLaws(ValidJob(solved(job).job)));
  EXPECT_GT(z[1] - z[0], 5 * kMillimetre);
  EXPECT_NEAR((z[0] + z[1] + z[2] + z[3]) / 4, 0, kLengthRounding);
}

TEST(StraightSetup, HasTheNearestHeightThatIsAllowed) {
  GrindJob job = endJob(OperationKind::kPrimaryEnd, 6);
  job.process().wheel_diameter = 500 * kMillimetre;
  const JobSetup setup = solved(job);
  EXPECT_EQ(setup.job.process().setup_height, -100 * kMillimetre);
  EXPECT_LT(zOfTeeth(withLaws(ValidJob(setup.job)))[0], -10 * kMillimetre);
}

TEST(StraightSetup, OfALeftHandToolHasTheSameSwivelOrTheMirroredOne) {
  EXPECT_EQ(solved(leftHand(endJob(OperationKind::kChamfer))).job.process().setup_swivel,
            solved(endJob(OperationKind::kChamfer)).job.process().setup_swivel);
  EXPECT_EQ(solved(leftHand(endJob(OperationKind::kGash))).job.process().setup_swivel,
            -solved(endJob(OperationKind::kGash)).job.process().setup_swivel);
  const GrindJob end = endJob(OperationKind::kPrimaryEnd);
  EXPECT_EQ(swivelOfPlane(leftHand(end)), swivelOfPlane(end));
  GrindJob left = leftHand(end);
  EXPECT_NE(refused(left, kMachine).find("process.wheel.profile = 0; allowed: 3, cup, for flanks of a left-hand end"),
            std::string::npos);
  left.process().wheel_profile = WheelShape::kCup;
  EXPECT_NE(refused(left, kMachine).find("process.wheel.side = 0; allowed: the lower face, which grinds the flank"),
            std::string::npos);
  left.process().wheel_side = WheelFace::kLower;
  EXPECT_NE(refused(left, kMachine).find("process.wheel.rim_mm = 0 mm; allowed: more than 0 for flanks of a left-hand"),
            std::string::npos);
  left.process().wheel_rim = left.process().wheel_diameter / 2 - 4 * kMillimetre;  // with a cutter of 10
  EXPECT_NE(refused(left, kMachine).find("what leaves a recess as wide as the cutter"), std::string::npos)
      << refused(left, kMachine);
  left.process().wheel_rim = 9 * kMillimetre;
  EXPECT_EQ(solved(left).job.process().setup_swivel, solved(end).job.process().setup_swivel);
}

TEST(StraightSetup, IsRefusedWithWhatTheMachineSwivels) {
  const Range narrow{-60 * kDegree, 60 * kDegree};
  EXPECT_EQ(refused(endJob(OperationKind::kPrimaryEnd), narrow),
            "the set-up takes a swivel of 81.76 deg; the machine swivels -60 to 60 deg; change "
            "cutter.end.clearance_deg");
  EXPECT_EQ(refused(endJob(OperationKind::kChamfer), narrow), "");
  EXPECT_EQ(refused(endJob(OperationKind::kChamfer), kMachine, SetupFigure::kSwivel),
            "the swivel of a chamfer is not kept; allowed: none");
  GrindJob job = endJob(OperationKind::kGash);
  job.process().gash_angle = 0;
  EXPECT_NE(refused(job, kMachine).find("process.angle_deg = 0 deg; allowed: 5 to 85 deg"), std::string::npos);
}

// The face at the touch against every place of the blank's end.
TEST(StraightSetup, TheLowerFaceTouchesTheBlankWhereTheSheetSays) {
  for (const OperationKind kind : {OperationKind::kPrimaryEnd, OperationKind::kChamfer}) {
    const JobSetup setup = solved(endJob(kind));
    const GrindProcess& p = setup.job.process();
    const double radius = 6 * kMillimetre, sin = std::sin(p.setup_swivel), cos = std::cos(p.setup_swivel);
    const double x = touchX(setup.job, 2 * radius);
    double nearest = 1, height = 0;
    for (int i = 0; i < 3600; ++i) {
      const double z = radius * std::sin(i * 0.1 * kDegree);
      // From the centre of the wheel along its axis down to the place, less half of the width.
      const double off = (-p.stock - x) * sin - (z - p.setup_height) * cos - kWidth / 2;
      if (off < nearest) nearest = off, height = z;
    }
    EXPECT_NEAR(nearest, 0, 1e-12);
    EXPECT_NEAR(height, radius, 1e-12);
  }
}

TEST(StraightSetup, ItsFileIsForItsPlaneAndItsWheelAlone) {
  for (const OperationKind kind : kKinds) {
    const GrindJob job = solved(endJob(kind)).job;
    const std::string text = withSetup("", "my.setup.yaml", "my.yaml", job);
    GrindJob back = job;
    clearSetup(back);
    takeSetup(text, "my.setup.yaml", back);
    EXPECT_EQ(back.process().setup_swivel, job.process().setup_swivel);
    EXPECT_EQ(back.process().setup_height, job.process().setup_height);
    visitJobFields([&](const JobField& field, auto of) {
      const std::string key = field.file_key;
      const auto begins_with = [&](const char* head) { return key.find(head) == 0; };
      const bool of_plane =
          (begins_with("cutter.end") && (key != "cutter.end.short_from_mm" || isEndFlank(kind))) ||
          begins_with("cutter.chamfer.") ||
          ((key == "cutter.spiral_angle_deg" || key == "cutter.rake_angle_deg") && kind == OperationKind::kChamfer) ||
          (begins_with("process.wheel.") && key.find("wear") == std::string::npos && key != "process.wheel.rim_mm") ||
          (key == "process.wheel.rim_mm" && isEndFlank(kind)) ||
          ((key == "process.angle_deg" || key == "process.past_mm" || begins_with("process.short.")) &&
           kind == OperationKind::kGash);
      GrindJob other = job;
      of(other) += 0.001 * shopScale(field.unit);
      const std::string said = test_support::refusalOf([&] { takeSetup(text, "my.setup.yaml", other); });
      EXPECT_EQ(said.find("solved for " + key + " = ") != std::string::npos,
                of_plane && key.find("tolerance") == std::string::npos && key != "cutter.end.uncut_diameter_mm")
          << key << ": " << said;
    });
  }
}

TEST(StraightSetup, IsOnTheSheet) {
  const auto sheet = [](OperationKind kind) { return setupSheet(solved(endJob(kind)), kMachine, std::nullopt); };
  const auto expect = [](const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  };
  expect(sheet(OperationKind::kPrimaryEnd),
         {"swivel           81.760 deg", "first tooth      A ", "last stroke      from X ", "passes           7 of",
          "0.967 mm across the plane", "The lower face grinds: X and Z are touched off with it.",
          "for D = 10 mm, 0.1 mm longer than the tool",
          "rim              ends 1.397 mm past the cutter's axis, at Y -6.397 mm\n", "periphery taken  0.000 mm",
          "next tooth       0.05 mm from the rim", "swivel           8.240 deg from the end"});
  expect(
      sheet(OperationKind::kGash),
      {"passes           5 of each tooth, which remove 4.950 mm along Y",
       "The rim and the upper face grind: Z, touched off with the lower one, relies on the width.", "at Y -19.495 mm"});
  expect(sheet(OperationKind::kChamfer), {"rim              ends 0.05 mm beyond the flank, "});
}

}  // namespace test_straight_setup
}  // namespace grinder
