// What the plan says of the end of the shipped end mill, with one of its numbers changed.

#include "tool/end_check.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/tool/z_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

namespace grinder {
namespace test_end_check {

using units::kDegree;
using units::kMillimetre;

using Change = std::function<void(GrindJob&)>;

GrindProcess& operationOf(GrindJob& job, OperationKind kind) {
  const auto is = [kind](const GrindProcess& p) { return p.kind == kind; };
  return *std::find_if(job.operations.begin(), job.operations.end(), is);
}

/// The shipped job with a change, up to the operation, and with the swivels of its planes.
GrindJob jobOf(const std::string& operation, const Change& change) {
  GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", operation);
  change(job);
  for (GrindProcess& process : job.operations) {
    if (!isStraight(process.kind)) continue;
    process.setup_swivel = swivelOfPlane(job.ofOperation(static_cast<int>(&process - job.operations.data())));
  }
  return job;
}

const Change kShipped = [](GrindJob&) {};

CutterCheck checked(const GrindJob& job) { return checkGroundCutter(withLaws(ValidJob(job))); }

double largest(const CutterCheck& check, ToolFigure figure) {
  const GroundFigure* found = find(check.figures, figure);
  return found ? found->largest.value : -1;
}

Change ofTeeth(const std::vector<double>& degrees) {
  return [degrees](GrindJob& job) {
    job.tooth_angles.clear();
    for (const double angle : degrees) job.tooth_angles.push_back(angle * kDegree);
  };
}

struct Asked {
  ToolFigure figure;
  double value, off;  ///< [m], [rad]
};

/// What the job file asks for; the flute's hook bends the chamfer's edge.
constexpr Asked kAsked[] = {{ToolFigure::kEndClearance, 8 * kDegree, 1e-6},
                            {ToolFigure::kEndSecondClearance, 18 * kDegree, 1e-6},
                            {ToolFigure::kEndDish, 2 * kDegree, 1e-6},
                            {ToolFigure::kEndRake, 3 * kDegree, 1e-6},
                            {ToolFigure::kEndLand, 0.4 * kMillimetre, 1e-9},
                            {ToolFigure::kPeripheryTaken, 0, 0},
                            {ToolFigure::kHeelDrag, 0, 0},
                            {ToolFigure::kUncutDiameter, 0.1 * kMillimetre, 0.03 * kMillimetre},
                            {ToolFigure::kChamferWidth, 0.2 * kMillimetre, 5e-6},
                            {ToolFigure::kChamferAngle, 45 * kDegree, 0.2 * kDegree},
                            {ToolFigure::kChamferClearance, 10 * kDegree, 0.1 * kDegree}};

void expectAsAsked(const CutterCheck& check) {
  EXPECT_TRUE(check.reasons.empty()) << text(check.reasons);
  EXPECT_EQ(check.figures.size(), std::size(kAsked) + 1);
  const GroundFigure* in_core = find(check.figures, ToolFigure::kGashInCore);
  ASSERT_TRUE(in_core);
  EXPECT_FALSE(in_core->asked);
  for (const Asked& asked : kAsked) {
    const GroundFigure* found = find(check.figures, asked.figure);
    ASSERT_TRUE(found) << toString(asked.figure);
    EXPECT_NEAR(found->least.value, asked.value, asked.off) << toString(asked.figure);
    EXPECT_NEAR(found->largest.value, asked.value, asked.off) << toString(asked.figure);
  }
}

TEST(EndCheck, TheShippedEndIsAsAskedWithOtherTeethToo) {
  for (const auto& teeth :
       std::vector<std::vector<double>>{{0, 90, 180, 270}, {0, 120, 240}, {0, 80, 185, 270}, {0, 95, 180, 280}}) {
    SCOPED_TRACE(testing::PrintToString(teeth));
    expectAsAsked(checked(jobOf("chamfer", ofTeeth(teeth))));
  }
}

/// Each pass takes up what the passes before have worn: of the face by X and Z, of a gash's rim by Y.
TEST(EndCheck, AWheelThatWearsGrindsTheSameEnd) {
  const CutterCheck fresh = checked(jobOf("chamfer", kShipped));
  const CutterCheck worn = checked(jobOf("chamfer", [](GrindJob& job) {
    for (GrindProcess& p : job.operations) {
      if (isStraight(p.kind)) p.wheel_wear_per_pass = 1e-6;
    }
  }));
  EXPECT_EQ(text(worn.reasons), "");
  ASSERT_EQ(worn.figures.size(), fresh.figures.size());
  for (std::size_t i = 0; i < fresh.figures.size(); ++i) {
    const GroundFigure &a = fresh.figures[i], &b = worn.figures[i];
    // The rims of smaller wheels end a little farther in.
    const double off = a.figure == ToolFigure::kUncutDiameter ? 0.2e-6 : 1e-9;
    EXPECT_NEAR(b.least.value, a.least.value, off) << toString(a.figure);
    EXPECT_NEAR(b.largest.value, a.largest.value, off) << toString(a.figure);
  }
}

/// The one that is not like the others tells of which tooth the figure is.
TEST(EndCheck, UnequalTeethAreMeasuredOneByOne) {
  const auto extremes = [](const std::vector<double>& teeth) {
    const CutterCheck check = checked(jobOf("end_primary", ofTeeth(teeth)));
    return *find(check.figures, ToolFigure::kUncutDiameter);
  };
  const double even = largest(checked(jobOf("end_primary", kShipped)), ToolFigure::kUncutDiameter);
  // The rim passes the axis the farther, the nearer its tooth's next one is to a quarter turn.
  const GroundFigure third = extremes({0, 90, 180, 280}), second = extremes({0, 90, 190, 270});
  EXPECT_NEAR(third.least.value, even, 1e-8);
  EXPECT_NEAR(second.least.value, even, 1e-8);
  EXPECT_GT(third.largest.value, even + 1e-6);
  EXPECT_NEAR(third.largest.value, second.largest.value, 1e-8);
  EXPECT_EQ(third.largest.tooth, (second.largest.tooth + 1) % 4);
}

GrindProcess& gashOf(GrindJob& job) { return operationOf(job, OperationKind::kGash); }

/// The sharp corner of an angled wheel's rim is what comes nearest to the axis: it goes out along a line in the face.
TEST(EndCheck, TellsHowFarTheGashesGoIntoTheCore) {
  struct Row {
    double rake, end_core, past;  ///< [deg], [mm]
  };
  const double radius = 6.81 / 2, sin = std::sin(40 * kDegree), cos = std::cos(40 * kDegree);
  for (const Row& row : {Row{0, 6.81, 0.2}, Row{0, 6.81, -1}, Row{0, 6.81, -3.5}, Row{0, 6.41, 0.2}, Row{0, 7.21, -1},
                         Row{9, 6.81, 0.2}, Row{12, 6.41, 0}}) {
    const CutterCheck check = checked(jobOf("gash", [&](GrindJob& job) {
      job.cutter.end_dish = 0;
      job.cutter.end_rake = row.rake * kDegree;
      job.cutter.core_diameter_end = row.end_core * kMillimetre;
      gashOf(job).gash_angle = 40 * kDegree;
      gashOf(job).gash_past = row.past * kMillimetre;
    }));
    const GroundFigure* gashed = find(check.figures, ToolFigure::kGashInCore);
    ASSERT_TRUE(gashed);
    // The line is at (t cos, -past + t sin) in the face, which is turned about Y by the rake.
    const double tilt = std::sin(row.rake * kDegree), a = sin * sin + cos * cos * tilt * tilt, b = row.past * sin / a;
    double core = radius, depth = 0;
    for (int i = 0; i < 60; ++i) {
      const double t = b + std::sqrt(b * b + (core * core - row.past * row.past) / a);
      depth = core + row.past < 0 ? 0 : t * cos * std::cos(row.rake * kDegree);
      core = radius + (row.end_core - 6.81) / 2 / 22 * depth;
    }
    const double off = row.rake > 0 ? 0.2e-6 : 1e-9;
    EXPECT_NEAR(gashed->largest.value, depth * kMillimetre, off) << row.rake << ' ' << row.end_core << ' ' << row.past;
    EXPECT_NEAR(gashed->largest.x, core * kMillimetre, off);
  }
}

/// What the flanks of two teeth leave between them is the gashes' to take. Else the blank's end stays there, in front
/// of an edge with a dish.
TEST(EndCheck, NothingMayStandInFrontOfTheEdgesOfTwoTeeth) {
  const auto with_gash = [](double angle, const Change& change) {
    return checked(jobOf("end_secondary", [&](GrindJob& job) {
      ofTeeth({0, 180})(job);
      gashOf(job).gash_angle = angle * kDegree;
      change(job);
    }));
  };
  const CutterCheck wide = with_gash(30, kShipped);
  EXPECT_TRUE(wide.reasons.empty()) << text(wide.reasons);
  EXPECT_EQ(largest(wide, ToolFigure::kHeelDrag), 0);
  const CutterCheck narrow = with_gash(45, [](GrindJob& job) {
    gashOf(job).wheel_profile = WheelShape::kStraight;
    gashOf(job).wheel_angle = 0;
    gashOf(job).wheel_width = 1 * kMillimetre;
  });
  const GroundFigure* drag = find(narrow.figures, ToolFigure::kHeelDrag);
  ASSERT_TRUE(drag);
  EXPECT_NEAR(drag->largest.value, (5 * kMillimetre - drag->largest.x) * std::tan(2 * kDegree), 1e-6);
  EXPECT_NE(text(narrow.reasons).find("the heel drag of tooth 1 is "), std::string::npos) << text(narrow.reasons);
}

/// A gash that is less far past the axis leaves a fin beside it, half a degree wide and 0.6 mm long.
TEST(EndCheck, FindsAFinThatIsNarrowerThanAnyStep) {
  for (const char* operation : {"end_secondary", "chamfer"}) {
    SCOPED_TRACE(operation);
    GrindJob job = readJobFile("jobs/slot_drill_d8_t2.yaml", operation);
    job.cutter.end_center_teeth = 0;
    job.cutter.end_short_from = gashOf(job).gash_short_past = 0;
    job.cutter.end_uncut_diameter = 0.3 * kMillimetre;
    for (GrindProcess& p : job.operations) {
      if (isEndFlank(p.kind)) p.wheel_diameter = 100 * kMillimetre;
    }
    EXPECT_TRUE(checked(job).reasons.empty());
    gashOf(job).gash_past = 0.2 * kMillimetre;
    const CutterCheck fin = checked(job);
    ASSERT_EQ(fin.reasons.size(), 1U);
    EXPECT_EQ(fin.reasons[0].detail, "heel drag");
    // Sampled on rays 0.03 deg apart, it stands 0.048 mm in front of the edge at most.
    EXPECT_GT(largest(fin, ToolFigure::kHeelDrag), 0.015 * kMillimetre);
    EXPECT_LT(largest(fin, ToolFigure::kHeelDrag), 0.049 * kMillimetre);
  }
}

TEST(EndCheck, RefusesAnEndThatIsNotAsAskedAndNamesTheFigure) {
  const auto thin = [](GrindJob& job) {
    gashOf(job).wheel_profile = WheelShape::kStraight;
    gashOf(job).wheel_angle = 0;
    gashOf(job).wheel_width = 3 * kMillimetre;
  };
  const struct {
    const char* operation;
    Change change;
    const char* says;
    ToolFigure figure;
    double least, most;  ///< of its largest [mm]
  } rows[]{
      // Behind a straight rim 3 mm wide, the lower face is at the tooth before from 3 mm outward.
      {"gash", thin, "the uncut diameter of tooth 1 is 6.0", ToolFigure::kUncutDiameter, 6, 6.1},
      {"end_primary", thin, "the uncut diameter of tooth 1 is 6.0", ToolFigure::kUncutDiameter, 6, 6.1},
      {"gash", [](GrindJob& job) { gashOf(job).gash_past = -0.5 * kMillimetre; },
       "the uncut diameter of tooth 1 is 1.4", ToolFigure::kUncutDiameter, 1, 2 * 0.9},
      {"end_secondary", [](GrindJob& job) { job.cutter.end_land = 4 * kMillimetre; },
       "the end land cannot be measured: nothing is left of it", ToolFigure::kUncutDiameter, 0, 0.3},
      {"gash", ofTeeth({0, 60, 120, 180, 240, 300}), "the uncut diameter of tooth 1 is 10 mm",
       ToolFigure::kUncutDiameter, 10, 10},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(&row - rows);
    const CutterCheck check = checked(jobOf(row.operation, row.change));
    EXPECT_NE(text(check.reasons).find(row.says), std::string::npos) << text(check.reasons);
    EXPECT_GE(largest(check, row.figure), row.least * kMillimetre - 1e-9);
    EXPECT_LE(largest(check, row.figure), row.most * kMillimetre + 1e-9);
  }
}

GrindJob centerCutting(const std::string& operation, const Change& change) {
  GrindJob job = readJobFile("jobs/center_cutting_d10_t4.yaml", operation);
  change(job);
  return job;
}

/// Teeth to the centre are whole from where the opposite one's rim ends past the axis, the others from where their
/// gashes have their bottoms or nearer to the axis than asked.
TEST(EndCheck, TeethToTheCentreBeginAtTheAxisAndTheOthersAsAsked) {
  const CutterCheck check = checked(centerCutting("chamfer", kShipped));
  EXPECT_EQ(text(check.reasons), "");
  const GroundFigure* uncut = find(check.figures, ToolFigure::kUncutDiameter);
  const GroundFigure* from = find(check.figures, ToolFigure::kShortFrom);
  const GroundFigure* drag = find(check.figures, ToolFigure::kHeelDrag);
  ASSERT_TRUE(uncut && from && drag);
  EXPECT_NEAR(uncut->largest.value, 2 * kEndGap, 0.02 * kMillimetre);
  EXPECT_EQ(uncut->largest.tooth % 2, 0);
  EXPECT_EQ(from->largest.tooth % 2, 1);
  EXPECT_LT(from->largest.value, 1.5 * kMillimetre);
  EXPECT_GT(from->least.value, 0.5 * kMillimetre);
  EXPECT_LT(drag->largest.value, 1e-6);
  EXPECT_EQ(find(checked(jobOf("chamfer", kShipped)).figures, ToolFigure::kShortFrom), nullptr);
}

/// Rounded corners of the wheel leave a nib at the axis, where no edge is.
TEST(EndCheck, NothingMayStandAtTheAxisInFrontOfTeethToTheCentre) {
  const CutterCheck check = checked(centerCutting("chamfer", [](GrindJob& job) {
    for (GrindProcess& p : job.operations) {
      if (isEndFlank(p.kind)) p.wheel_corner_radius_lower = 0.1 * kMillimetre;
    }
  }));
  const GroundFigure* drag = find(check.figures, ToolFigure::kHeelDrag);
  ASSERT_TRUE(drag);
  EXPECT_GT(drag->largest.value, 5e-6);
  EXPECT_LT(drag->largest.x, 0.1 * kMillimetre);
  EXPECT_NE(text(check.reasons).find("the heel drag of tooth 1 is "), std::string::npos) << text(check.reasons);
}

TEST(EndCheck, RefusesShortTeethThatBeginTooFarOut) {
  const CutterCheck check =
      checked(centerCutting("chamfer", [](GrindJob& job) { gashOf(job).gash_short_past = -1.5 * kMillimetre; }));
  const std::string why = text(check.reasons);
  EXPECT_NE(why.find("the beginning of the short edge of tooth 2 is 1.6"), std::string::npos) << why;
}

/// With one of two teeth to the centre.
CutterCheck slotDrill(double second, double short_past = -0.5) {
  GrindJob job = readJobFile("jobs/slot_drill_d8_t2.yaml", "chamfer");
  ofTeeth({0, second})(job);
  gashOf(job).gash_short_past = short_past * kMillimetre;
  return checked(job);
}

/// Behind a wide pitch the flank goes on, and the gash takes the rest.
TEST(EndCheck, ASlotDrillMayHaveUnequalPitches) {
  for (const double second : {160, 165, 172, 180, 190, 200}) {
    SCOPED_TRACE(second);
    const CutterCheck check = slotDrill(second);
    EXPECT_EQ(text(check.reasons), "");
    EXPECT_EQ(largest(check, ToolFigure::kUncutDiameter), 0);
    EXPECT_LT(largest(check, ToolFigure::kHeelDrag), 1e-6);
    const GroundFigure* from = find(check.figures, ToolFigure::kShortFrom);
    ASSERT_TRUE(from);
    EXPECT_EQ(from->largest.tooth, 1);
    EXPECT_GT(from->least.value, 0.6 * kMillimetre);  // by which the rim of the other passes the axis
  }
}

/// Between flank and gash the blank's end stays, in front of an edge with a dish.
TEST(EndCheck, TheHeelOfASlotDrillDragsIfAPitchIsTooWide) {
  for (const double second : {120, 210}) {
    SCOPED_TRACE(second);
    const CutterCheck check = slotDrill(second);
    const GroundFigure* drag = find(check.figures, ToolFigure::kHeelDrag);
    ASSERT_TRUE(drag);
    EXPECT_GT(drag->largest.value, 0.05 * kMillimetre);
    EXPECT_NEAR(drag->largest.value, (4 * kMillimetre - drag->largest.x) * std::tan(2 * kDegree), 1e-6);
    EXPECT_NE(text(check.reasons).find("the heel drag of tooth 1 is "), std::string::npos) << text(check.reasons);
  }
}

/// By so steep a plane, the next tooth's edge is seen to begin 0.13 mm from the axis, which the rim passes by 0.1 mm.
TEST(EndCheck, RefusesARimThatCannotPassBetweenAxisAndNextTooth) {
  GrindJob job = readJobFile("jobs/slot_drill_d8_t2.yaml", "end_secondary");
  ofTeeth({0, 90})(job);
  job.cutter.end_short_from = 0.2 * kMillimetre;
  job.cutter.end_land = 0.02 * kMillimetre;
  const auto planned = [&](double second_clearance) {
    job.cutter.end_second_clearance = second_clearance * kDegree;
    job.process().setup_swivel = swivelOfPlane(job);
    return ValidJob(job);
  };
  EXPECT_NO_THROW(planned(30));
  try {
    planned(60);
    ADD_FAILURE();
  } catch (const InvalidJob& error) {
    EXPECT_NE(
        std::string(error.what()).find("flank of tooth 1: the wheel's rim cannot end clear of the next tooth, by "),
        std::string::npos)
        << error.what();
  }
}

/// The bottom of the short tooth's gash rises from the end at 35 deg, and from the face by the wheel's 45 deg.
TEST(EndCheck, TheShortGashOfASlotDrillCutsTheLongEdgeIfItPassesTheAxis) {
  const double off = 15 * kDegree, rise = std::tan(2 * kDegree) * std::tan(35 * kDegree);
  for (const double past : {0.3, 0.5, 0.8}) {
    SCOPED_TRACE(past);
    const CutterCheck check = slotDrill(165, past);
    const double reach = (past * kMillimetre - 4 * kMillimetre * rise) /
                         (std::cos(off) - rise + std::sin(off) * std::tan(45 * kDegree) / std::cos(35 * kDegree));
    EXPECT_NEAR(largest(check, ToolFigure::kUncutDiameter), 2 * reach, 0.015 * kMillimetre);
    EXPECT_NE(text(check.reasons).find("the uncut diameter of tooth 1 is "), std::string::npos) << text(check.reasons);
  }
}

/// The plan of a gash tells which edges it spoils, once the flank that follows can be planned.
TEST(EndCheck, AGashKnowsTheUncutDiameterOfTheFlankThatFollows) {
  GrindJob job = jobOf("gash", kShipped);
  const double foreseen = largest(checked(job), ToolFigure::kUncutDiameter);
  EXPECT_NEAR(foreseen, largest(checked(jobOf("end_primary", kShipped)), ToolFigure::kUncutDiameter), 1e-9);
  GrindJob not_set_up = job;
  operationOf(not_set_up, OperationKind::kPrimaryEnd).setup_swivel = 0;
  const CutterCheck alone = checked(not_set_up);
  EXPECT_EQ(find(alone.figures, ToolFigure::kUncutDiameter), nullptr);
  EXPECT_NEAR(largest(alone, ToolFigure::kEndRake), 3 * kDegree, 1e-6);
  EXPECT_TRUE(alone.reasons.empty());
}

/// Gash and chamfer alone; a left-hand one has its flutes and its gash mirrored in Z, and its chamfer in Y.
Change withoutFlanks(CutDirection cut) {
  return [cut](GrindJob& job) {
    const auto is_left_out = [](const GrindProcess& p) { return isRelief(p.kind) || isEndFlank(p.kind); };
    job.operations.erase(std::remove_if(job.operations.begin(), job.operations.end(), is_left_out),
                         job.operations.end());
    job.operation = static_cast<int>(job.operations.size()) - 1;
    if (cut == CutDirection::kRightHand) return;
    job.cutter.cut = cut;
    job.cutter.spiral_angle *= -1;
    for (GrindProcess& p : job.operations) {
      p.wheel_side = WheelFace::kLower;
      p.setup_swivel *= -1;
      p.setup_height *= -1;
    }
  };
}

TEST(EndCheck, WithoutFlanksThereIsNoHeel) {
  GrindJob job = readJobFile("jobs/center_cutting_d10_t4.yaml", "chamfer");
  withoutFlanks(CutDirection::kRightHand)(job);
  const CutterCheck check = checked(job);
  EXPECT_EQ(find(check.figures, ToolFigure::kHeelDrag), nullptr);
  EXPECT_EQ(text(check.reasons).find("heel drag"), std::string::npos) << text(check.reasons);
}

TEST(EndCheck, ALeftHandEndMeasuresAsItsMirrorImage) {
  const CutterCheck right = checked(jobOf("chamfer", withoutFlanks(CutDirection::kRightHand)));
  const CutterCheck left = checked(jobOf("chamfer", withoutFlanks(CutDirection::kLeftHand)));
  EXPECT_EQ(text(left.reasons), text(right.reasons));
  ASSERT_EQ(left.figures.size(), right.figures.size());
  EXPECT_GT(left.figures.size(), 4u);
  for (const GroundFigure& figure : right.figures) {
    const GroundFigure* other = find(left.figures, figure.figure);
    ASSERT_TRUE(other);
    EXPECT_NEAR(other->least.value, figure.least.value, 1e-9) << toString(figure.figure);
    EXPECT_NEAR(other->largest.value, figure.largest.value, 1e-9) << toString(figure.figure);
  }
}

}  // namespace test_end_check
}  // namespace grinder
