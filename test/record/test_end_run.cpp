// A run on the end of the shipped end mill, from the positions that the drive read to the verdict.

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/motion/setpoint_stream.h"
#include "flute_grinder/record/verdict.h"
#include "flute_grinder/tool/z_law.h"
#include "motion/examples.h"
#include "record/ground_strokes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace grinder {
namespace test_end_run {

using namespace units;

constexpr double kOff = 5 * kMicrometre;
const Axes kExact = Axes::Zero();

/// A job, and the flutes and reliefs that it grinds.
struct Planned {
  explicit Planned(const GrindJob& asked) : job(withLaws(ValidJob(asked))), cutter(groundCutterOf(job)) {}

  ValidJob job;
  GroundCutter cutter;
};

/// Of the shipped end mill, computed once.
const Planned& planned(const std::string& operation) {
  static std::map<std::string, Planned> all;
  return all.try_emplace(operation, readJobFile("jobs/end_mill_d10_t4.yaml", operation)).first->second;
}

/// @param broken whether the wheel is retracted from a stroke, and begins it anew.
std::vector<Setpoint> setpointsOf(const ValidJob& job, bool broken) {
  const Machine machine = test_support::roomyMachine();
  SetpointStream stream(std::make_shared<GrindProgram>(job, machine, machine.park));
  std::vector<Setpoint> all;
  Setpoint p;
  const std::size_t last = job.depths().size() - 1;
  const auto take = [&] {
    while (stream.next(p)) {
      all.push_back(p);
      if (broken && p.tooth == 1 && p.pass == last && p.move == MoveKind::kStroke && p.move_fraction > 0.6) {
        stream.hold();
      }
    }
  };
  take();
  if (broken) {
    EXPECT_EQ(stream.rest(), Rest::kHeld);
    broken = false;
    stream.retract();
    take();
    stream.resume();
    take();
  }
  EXPECT_EQ(stream.rest(), Rest::kEnd);
  return all;
}

RunStrokes runOf(const Planned& on, const Axes& error, bool broken = false) {
  RunStrokes strokes(on.job, on.cutter);
  const std::vector<Setpoint> all = setpointsOf(on.job, broken);
  for (std::size_t i = 1; i < all.size(); ++i) strokes.add(all[i], all[i - 1].position + error);
  strokes.finish();
  return strokes;
}

GroundTool toolOf(const RunStrokes& run) { return measure("", run, {0, run.job()->cutter.flute_length}); }

Axes along(int axis, double error) {
  Axes axes = Axes::Zero();
  axes[axis] = error;
  return axes;
}

void expectSameFigures(const GroundTool& tool, const GroundTool& other, double off) {
  ASSERT_EQ(tool.check.figures.size(), other.check.figures.size());
  for (std::size_t i = 0; i < tool.check.figures.size(); ++i) {
    const GroundFigure &a = tool.check.figures[i], &b = other.check.figures[i];
    EXPECT_NEAR(a.least.value, b.least.value, off) << toString(a.figure);
    EXPECT_NEAR(a.largest.value, b.largest.value, off) << toString(a.figure);
  }
}

/// Off its plane, the wheel is as deep as the error along the spindle; along Y it is only in a gash, whose bottom the
/// rim is.
TEST(EndRun, AConstantErrorIsAsDeepAsItIsAcrossThePlane) {
  const struct {
    const char* operation;
    int axis;
    double error, depth;
  } rows[]{{"end_primary", kX, kOff, kOff * std::sin(81.76 * kDegree)},
           {"end_primary", kX, -kOff, 0},
           {"end_primary", kY, -kOff, 0},
           {"end_secondary", kZ, -kOff, kOff * std::cos(71.9031 * kDegree)},
           {"chamfer", kX, kOff, kOff * std::sin(48.0889 * kDegree)},
           {"gash", kZ, kOff, kOff * std::cos(3 * kDegree)},
           {"gash", kZ, -kOff, 0},
           {"gash", kY, -kOff, kOff * std::cos(45 * kDegree)}};
  for (const auto& row : rows) {
    SCOPED_TRACE(std::string(row.operation) + " " + std::to_string(row.axis));
    double deepest = 0;
    for (const Gouge& gouge : gougesOf(runOf(planned(row.operation), along(row.axis, row.error)), 1e-9)) {
      deepest = std::max(deepest, gouge.depth);
    }
    EXPECT_NEAR(deepest, row.depth, 1e-9);  // the set-up's swivels are rounded
  }
}

/// The bottom of a short tooth's gash may have an angle of its own.
TEST(EndRun, AGashThatIsTooDeepIsSoAcrossTheBottomOfItsTooth) {
  GrindJob job = readJobFile("jobs/center_cutting_d10_t4.yaml", "gash");
  job.process().gash_short_angle = 30 * kDegree;
  const std::vector<Gouge> gouges = gougesOf(runOf(Planned(job), along(kY, -kOff)), 1e-9);
  EXPECT_FALSE(gouges.empty());
  for (const Gouge& gouge : gouges) {
    EXPECT_NEAR(gouge.depth, kOff * std::cos((gouge.place.tooth % 2 ? 30 : 45) * kDegree), 1e-9) << gouge.place.tooth;
  }
}

/// A secondary flank that is lower meets the primary one nearer to the edge.
TEST(EndRun, AFlankIsMeasuredWhereItWasGround) {
  const Planned& job = planned("end_secondary");
  const GroundTool exact = toolOf(runOf(job, kExact)), off = toolOf(runOf(job, along(kX, kOff)));
  const double nearer = kOff / (std::tan(18 * kDegree) - std::tan(8 * kDegree));
  for (const GroundFigure& figure : exact.check.figures) {
    const double shift = figure.figure == ToolFigure::kEndLand ? -nearer : 0;
    const double value = find(off.check.figures, figure.figure)->largest.value;
    EXPECT_NEAR(value - figure.largest.value, shift, 2e-9) << toString(figure.figure);
  }
}

TEST(EndRun, AStrokeThatIsBegunAnewCountsAsAWhole) {
  const Planned& job = planned("end_primary");
  const RunStrokes whole = runOf(job, kExact), broken = runOf(job, kExact, true);
  EXPECT_EQ(broken.strokes().size(), whole.strokes().size() + 1);
  expectSameFigures(toolOf(broken), toolOf(whole), 1e-12);
  EXPECT_TRUE(gougesOf(broken, 1e-9).empty());
}

TEST(EndRun, IsReadFromItsRecordAsItWas) {
  const Planned& job = planned("end_secondary");
  const RunStrokes run = runOf(job, along(kX, kOff));
  const Json json = Json::parse(toJson(run.strokes()).dump());
  EXPECT_EQ(json.back().at("x_nm").at(0), 5000);
  const RunStrokes again(job.job, runStrokesFrom(json));
  EXPECT_EQ(toJson(again.strokes()), json);
  expectSameFigures(toolOf(again), toolOf(run), 5e-9);
}

Verdict verdictOn(const RunStrokes& run) {
  const GroundTool tool = toolOf(run);
  return grinder::verdictOn(criteriaOfTool(run.job(), &tool, {0.05, 0.02, 50, 5, 1}), "done", 0);
}

TEST(EndRun, IsPassedIfAllTeethAreGroundWithoutAGouge) {
  const Planned& on = planned("chamfer");
  const RunStrokes run = runOf(on, kExact);
  EXPECT_EQ(verdictOn(run).verdict, "passed");
  std::vector<RunStroke> strokes = run.strokes();
  const auto is_third = [](const RunStroke& stroke) { return stroke.place.tooth == 2; };
  strokes.erase(std::remove_if(strokes.begin(), strokes.end(), is_third), strokes.end());
  const Verdict missing = verdictOn(RunStrokes(on.job, strokes, on.cutter));
  EXPECT_EQ(missing.verdict, "incomplete");
  EXPECT_GT(missing.because.size(), askedOfEnd(on.job).size());
  for (const std::string& why : missing.because) EXPECT_NE(why.find(": not measured"), std::string::npos) << why;
  const Verdict gouged = verdictOn(runOf(planned("end_primary"), along(kX, 20 * kMicrometre)));
  EXPECT_EQ(gouged.verdict, "failed");
  EXPECT_EQ(gouged.because, std::vector<std::string>{"gouge"});
}

}  // namespace test_end_run
}  // namespace grinder
