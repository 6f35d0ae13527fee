#include "flute_grinder/motion/grind_program.h"

#include "curve/reference.h"
#include "plans.h"
#include "refusal.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace grinder {
namespace test_grind_program {

using namespace test_support;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

GrindProgram programOf(const GrindJob& job, const ToothPass& first = {}) {
  return GrindProgram(ValidJob(job), plainMachine(), {plainMachine().park, first});
}

/// Tooth and pass of every stroke, as "tooth/pass".
std::vector<std::string> strokesOf(const GrindProgram& program) {
  std::vector<std::string> strokes;
  for (const Move& move : program.moves()) {
    if (move.kind == MoveKind::kStroke) strokes.push_back(std::to_string(move.tooth) + "/" + std::to_string(move.pass));
  }
  return strokes;
}

const Move& firstOf(const GrindProgram& program, MoveKind kind) {
  for (const Move& move : program.moves()) {
    if (move.kind == kind) return move;
  }
  throw std::logic_error("no such move");
}

/// Two teeth, three passes.
GrindJob manyPasses() {
  GrindJob j = paperJob();
  j.tooth_angles = {0, 3};
  j.process().depth = 1.5e-3;
  return j;
}

TEST(GrindProgram, StandsWhereThePapersEquationsSay) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 2};
  const GrindProgram program = programOf(job, {1, 0});
  const test_support::ReferenceCurve curve(job.cutter);
  const double growth = std::tan(5 * units::kDegree);
  const double sin_rake = std::sin(8 * units::kDegree);
  const Move& index = firstOf(program, MoveKind::kIndex);
  EXPECT_EQ(index.to[kX], plainMachine().park[kX]);
  EXPECT_EQ(index.to[kY], plainMachine().park[kY]);
  EXPECT_EQ(index.to[kZ], plainMachine().park[kZ]);
  EXPECT_NEAR(index.to[kA], 2 + static_cast<double>(curve.a(-1e-3L)), 1e-15);
  const Move& position = firstOf(program, MoveKind::kPosition);
  EXPECT_NEAR(position.to[kX], -1e-3, 1e-18);
  EXPECT_EQ(position.to[kY], plainMachine().park[kY]);
  EXPECT_NEAR(position.to[kZ], -1e-3 * growth * sin_rake, 1e-18);
  EXPECT_EQ(position.to[kA], index.to[kA]);
  const Move& approach = firstOf(program, MoveKind::kApproach);
  EXPECT_NEAR(approach.to[kY], -1e-3 * growth + 5e-3, 1e-17);
  const Move& infeed = firstOf(program, MoveKind::kInfeed);
  EXPECT_NEAR(infeed.to[kY], -1e-3 * growth - 0.5e-3, 1e-17);
  const Move& stroke = firstOf(program, MoveKind::kStroke);
  EXPECT_NEAR(stroke.to[kX], 31e-3, 1e-17);
  EXPECT_NEAR(stroke.to[kY], 31e-3 * growth - 0.5e-3, 1e-17);
  EXPECT_NEAR(stroke.to[kZ], 31e-3 * growth * sin_rake, 1e-17);
  EXPECT_NEAR(stroke.to[kA], 2 + static_cast<double>(curve.a(31e-3L)), 1e-14);
}

// X is rounded, and on the path of the edge Y, Z and A are computed from it.
TEST(GrindProgram, HasTheSizesOfWhatPositionsAreComputedFrom) {
  const GrindJob job = paperJob();
  ZCorrection correction;
  correction.from = -1e-3;
  correction.piece = 32e-3;
  correction.pieces = 1;
  for (std::size_t i = 0; i < 6; ++i) correction.coefficients[i] = 32e-6 * static_cast<double>(i);  // dZ/dX = 1e-3
  const GrindProgram program(ValidJob(job).withZCorrections({correction}), plainMachine(), {plainMachine().park, {}});
  const double y = 31e-3 * std::tan(5 * units::kDegree);
  EXPECT_NEAR(program.terms()[kY], y, 1e-12);
  EXPECT_NEAR(program.terms()[kZ], y * std::sin(8 * units::kDegree) + 31e-3 * 1e-3, 1e-12);
  const test_support::ReferenceCurve curve(job.cutter);
  const double slope = static_cast<double>(curve.a(31e-3L + 1e-6L) - curve.a(31e-3L - 1e-6L)) / 2e-6;
  EXPECT_NEAR(program.terms()[kA], 31e-3 * slope, 1e-6);
}

TEST(GrindProgram, EveryPassIndexesGoesOverTheWorkDownAlongAndOut) {
  std::vector<MoveKind> expected, kinds;
  for (int i = 0; i < 6; ++i) {
    expected.insert(expected.end(), {MoveKind::kIndex, MoveKind::kPosition, MoveKind::kApproach, MoveKind::kInfeed,
                                     MoveKind::kStroke, MoveKind::kRetract});
  }
  expected.push_back(MoveKind::kReturn);
  Machine machine = plainMachine();
  machine.park << 0.05, 0.06, 0.01, 0.7;
  const GrindProgram program(ValidJob(manyPasses()), machine, machine.park);
  for (const Move& move : program.moves()) kinds.push_back(move.kind);
  EXPECT_EQ(kinds, expected);
  EXPECT_TRUE((program.moves().back().to == machine.park).all());
}

/// Its even points drift by up to as much again as its odd points deviate.
TEST(GrindProgram, GivesTheStepsOfPublishedHalfOfTheTolerance) {
  const auto speed = [](EvenStepRule rule, double tolerance) {
    GrindJob job = paperJob();
    job.process().feed = 0.1;
    job.interpolation = {rule, tolerance, 1e-3};
    const GrindProgram program(ValidJob(job), strongMachine(), strongMachine().park);
    EXPECT_EQ(causesOf(program.schedule().feedLimits()), "interpolation tolerance");
    return program.schedule().feedSpeed();
  };
  EXPECT_EQ(speed(EvenStepRule::kPublished, 2e-9), speed(EvenStepRule::kExact, 1e-9));
}

TEST(GrindProgram, ContinuesFromAPassOfATooth) {
  EXPECT_EQ(strokesOf(programOf(manyPasses(), {0, 2})), (std::vector<std::string>{"0/2", "1/0", "1/1", "1/2"}));
  EXPECT_EQ(strokesOf(programOf(manyPasses(), {1, 2})), (std::vector<std::string>{"1/2"}));
  GrindJob job = manyPasses();
  job.process().order = GrindOrder::kPassMajor;
  EXPECT_EQ(strokesOf(programOf(job, {1, 1})), (std::vector<std::string>{"1/1", "0/2", "1/2"}));
}

TEST(GrindProgram, RefusesAFirstPassThatIsNotThere) {
  for (const ToothPass& first : {ToothPass{-1, 0}, ToothPass{2, 0}, ToothPass{0, -1}, ToothPass{0, 3}}) {
    const std::string error = test_support::refusalOf<std::invalid_argument>([&] { programOf(manyPasses(), first); });
    EXPECT_TRUE(contains(error, "first_tooth = " + std::to_string(first.tooth))) << error;
    EXPECT_TRUE(contains(error, "first_pass = " + std::to_string(first.pass))) << error;
    EXPECT_TRUE(contains(error, "allowed: 0 to 1 and 0 to 2")) << error;
  }
}

TEST(GrindProgram, RefusesAMachineOrAStartThatNoJobMayRunOn) {
  const struct {
    const char* part;  // of the text
    std::function<void(Machine&, Axes& start)> change;
  } rows[]{{"period", [](Machine& m, Axes&) { m.period = 0; }},
           {"period", [](Machine& m, Axes&) { m.period = -1e-3; }},
           {"period", [](Machine& m, Axes&) { m.period = kNan; }},
           {"period", [](Machine& m, Axes&) { m.period = 2; }},
           {"period", [](Machine& m, Axes&) { m.period = kInf; }},
           {"velocity", [](Machine& m, Axes&) { m.limits.max_velocity[kX] = 0; }},
           {"velocity", [](Machine& m, Axes&) { m.limits.max_velocity[kA] = -1; }},
           {"velocity", [](Machine& m, Axes&) { m.limits.max_velocity[kY] = kNan; }},
           {"velocity", [](Machine& m, Axes&) { m.limits.max_velocity[kY] = kInf; }},
           {"acceleration", [](Machine& m, Axes&) { m.limits.max_acceleration[kZ] = 0; }},
           {"acceleration", [](Machine& m, Axes&) { m.limits.max_acceleration[kX] = kNan; }},
           {"jerk", [](Machine& m, Axes&) { m.limits.max_jerk[kA] = 0; }},
           {"jerk", [](Machine& m, Axes&) { m.limits.max_jerk[kA] = kNan; }},
           {"position limits", [](Machine& m, Axes&) { m.limits.min_position[kX] = m.limits.max_position[kX]; }},
           {"position limits", [](Machine& m, Axes&) { m.limits.min_position[kZ] = 1; }},
           {"position limits", [](Machine& m, Axes&) { m.limits.min_position[kY] = kNan; }},
           {"position limits", [](Machine& m, Axes&) { m.limits.max_position[kA] = kInf; }},
           {"position limits", [](Machine& m, Axes&) { m.limits.min_position[kA] = -2e9; }},
           {"max_job_duration", [](Machine& m, Axes&) { m.max_job_duration = 0; }},
           {"max_job_duration", [](Machine& m, Axes&) { m.max_job_duration = kNan; }},
           {"max_job_duration", [](Machine& m, Axes&) { m.max_job_duration = 2e9; }},
           {"start", [](Machine&, Axes& start) { start[kA] = kNan; }},
           {"start", [](Machine&, Axes& start) { start[kX] = kInf; }},
           {"park", [](Machine& m, Axes&) { m.park[kZ] = kNan; }},
           {"park position axis Y = 7 mm", [](Machine& m, Axes&) { m.park[kY] = 7e-3; }}};
  for (const auto& row : rows) {
    SCOPED_TRACE(&row - rows);
    Machine machine = plainMachine();
    Axes start = machine.park;
    row.change(machine, start);
    const std::string error =
        test_support::refusalOf<std::invalid_argument>([&] { GrindProgram(ValidJob(paperJob()), machine, start); });
    EXPECT_TRUE(contains(error, row.part)) << row.part << ", got: " << error;
  }
  Machine fastest = plainMachine();
  fastest.period = 1e-6;
  RunStart run{fastest.park};
  const auto refusal = [&] {
    return test_support::refusalOf<std::invalid_argument>([&] { GrindProgram(ValidJob(paperJob()), fastest, run); });
  };
  run.offset[kZ] = 1000;
  EXPECT_EQ(refusal(), "");
  run.offset[kZ] = 1000.1;
  EXPECT_TRUE(contains(refusal(), "work offsets"));
  // Of the clearance of 31 mm tan 5 deg + 5 mm with the offset.
  run.offset << 0, 0.045, 0, 0;
  EXPECT_TRUE(contains(refusal(), "park position axis Y = 50 mm; allowed for this job: at least 52.71")) << refusal();
}

RC_GTEST_PROP(GrindProgramProperty, LiftsOnlyWhereItStartsBelowThePark, ()) {
  const Work work = *test_support::work(3000);
  const GrindProgram program = work.program();
  const bool low = work.start[kY] < work.machine.park[kY];
  RC_ASSERT((program.moves().front().kind == MoveKind::kLift) == low);
  if (low) RC_ASSERT(program.moves().front().to[kY] == work.machine.park[kY]);
  for (std::size_t i = 1; i < program.moves().size(); ++i) RC_ASSERT(program.moves()[i].kind != MoveKind::kLift);
}

}  // namespace test_grind_program
}  // namespace grinder
