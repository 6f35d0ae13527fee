// From the positions that a drive read to the cutter as ground, against brute force over every position.

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/motion/setpoint_stream.h"
#include "flute_grinder/tool/gouge.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/run_strokes.h"
#include "flute_grinder/tool/z_law.h"

#include "motion/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace grinder {
namespace test_run_strokes {

using units::kDegree;
using units::kMillimetre;
using units::kPi;

/// A position that was read, and the setpoint it belongs to.
struct Read {
  Setpoint setpoint;
  Axes at;
};
using Error = std::function<Axes(const Setpoint&)>;

Axes along(int axis, double error) {
  Axes axes = Axes::Zero();
  axes[axis] = error;
  return axes;
}

/// Of a move of a pass.
Error errorOf(int pass, MoveKind move, const Axes& error) {
  return [=](const Setpoint& p) { return p.pass == pass && p.move == move ? error : Axes(Axes::Zero()); };
}

/// One tooth of the shipped roughing cutter in six passes: 0.4 to 1.6 mm, then a finishing pass and a spark-out.
GrindJob roughing() {
  GrindJob job = readJobFile("jobs/roughing_d10_t4.yaml");
  job.tooth_angles = {0};
  job.process().wheel_wear_per_pass = 0;
  job.process().feed *= 3;
  return job;
}

/// A straight flute under the middle of the wheel: its floor is the wheel's, its walls are planes.
GrindJob straight() {
  GrindJob job = roughing();
  job.cutter.spiral_angle = 0;
  job.process().setup_swivel = 0;
  job.process().setup_height = 0;
  return job;
}

/// All that a drive reads in a job, with errors of the axes.
std::vector<Read> readOf(const ValidJob& job, const Error& error) {
  const Machine machine = test_support::roomyMachine();
  std::vector<Read> all;
  SetpointStream stream(std::make_shared<GrindProgram>(job, machine, machine.park));
  Setpoint p;
  while (stream.next(p)) all.push_back({p, p.position + error(p)});
  return all;
}

RunStrokes runOf(const ValidJob& job, const std::vector<Read>& read, std::optional<GroundCutter> before = {}) {
  RunStrokes strokes(job, std::move(before));
  for (std::size_t i = 1; i < read.size(); ++i) strokes.add(read[i].setpoint, read[i - 1].at);
  strokes.finish();
  return strokes;
}

RunStrokes runOf(const GrindJob& job, const Error& error) {
  const ValidJob valid = withLaws(ValidJob(job));
  return runOf(valid, readOf(valid, error));
}

const Error kExact = [](const Setpoint&) { return Axes(Axes::Zero()); };

/// Whether a straight wheel, as worn by then but larger by `grown`, took a point away in one of the positions.
bool removed(const GrindJob& job, const std::vector<Read>& read, double x, double r, double theta, double grown) {
  const GrindProcess& p = job.process();
  const double sn = std::sin(p.setup_swivel), cs = std::cos(p.setup_swivel);
  const double half = p.wheel_width / 2 + grown;
  for (const Read& one : read) {
    const double radius = p.wheel_diameter / 2 - one.setpoint.pass * p.wheel_wear_per_pass + grown;
    const double angle = theta - one.at[kA];
    const double dx = x - one.at[kX];
    const double dy = r * std::cos(angle) - (job.cutter.end_diameter / 2 + p.wheel_diameter / 2 + one.at[kY]);
    if (dy < -radius || std::abs(dx) > radius) continue;
    const double dz = r * std::sin(angle) - (p.setup_height + one.at[kZ]);
    const double w = dz * cs - dx * sn, t = dz * sn + dx * cs;
    if (std::abs(w) <= half && dy * dy + t * t <= radius * radius) return true;
  }
  return false;
}

bool removed(const GroundCutter& cutter, double x, double r, double theta) {
  const auto arc = cutter.arc(cutter.flutes().front(), x, r);
  if (!arc) return false;
  const double turns = std::floor((theta - arc->low) / (2 * kPi));
  return theta - turns * 2 * kPi <= arc->high;
}

double coreAt(const GroundCutter& cutter, double x) { return cutter.section(x).core_radius; }

TEST(RunStrokes, AnExactRunIsThePlanAndKeepsEveryStroke) {
  GrindJob job = roughing();
  job.cutter.chordal_rake_depth = 0.3e-3;
  const RunStrokes strokes = runOf(job, kExact);
  ASSERT_EQ(strokes.strokes().size(), passDepths(job.process()).size());
  for (const RunStroke& stroke : strokes.strokes()) {
    EXPECT_EQ(stroke.move, MoveKind::kStroke);
    EXPECT_NEAR(stroke.range.from, -job.process().overtravel_end, 1e-12);
    EXPECT_NEAR(stroke.range.to, job.cutter.flute_length + job.process().overtravel_shank, 1e-12);
  }
  const GroundCutter cutter = strokes.cutter(), planned = groundCutterOf(ValidJob(job));
  EXPECT_EQ(cutter.flutes().front().size(), 1u);
  EXPECT_EQ(cutter.chordalRakeDepth(), 0.3e-3);
  EXPECT_EQ(planned.chordalRakeDepth(), 0.3e-3);
  for (const double x : {0.0, 0.011, 0.022}) {
    const ToothSection one = cutter.section(x).teeth.front(), other = planned.section(x).teeth.front();
    EXPECT_NEAR(one.depth, other.depth, 1e-8);
    EXPECT_NEAR(one.edge.value(), other.edge.value(), 4e-6);
    EXPECT_NEAR(one.rake.value(), other.rake.value(), 4e-5);
    EXPECT_EQ(one.complete, other.complete);
  }
  EXPECT_TRUE(gougesOf(strokes, 1e-6).empty());
}

// The wheel wears, errors of the axes are other in every move, and some are small enough for strokes to be left out.
TEST(RunStrokes, WhatIsRemovedIsWhatEveryPositionRemovesTogether) {
  constexpr int kCases = 3, kPoints = 100;
  constexpr double kMargin = 12e-6;  // samples are averaged
  std::mt19937 random(7);
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<>(from, to)(random); };
  int taken = 0;
  for (int i = 0; i < kCases; ++i) {
    GrindJob job = roughing();
    job.process().feed *= 2;
    job.process().wheel_wear_per_pass = i % 2 * 20e-6;
    std::vector<std::vector<Axes>> errors;
    for (std::size_t pass = 0; pass < passDepths(job.process()).size(); ++pass) {
      errors.emplace_back();
      for (int move = 0; move < kMoveKindCount; ++move) {
        const double size = std::pow(10.0, uniform(-7.5, -3.5));
        errors.back().push_back(Axes(0, uniform(-size, size), uniform(-size, size), uniform(-size, size) / 0.005));
      }
    }
    const auto read = readOf(ValidJob(job), [&](const Setpoint& p) {
      return p.move == MoveKind::kReturn ? Axes(Axes::Zero()) : errors[p.pass][static_cast<std::size_t>(p.move)];
    });
    const GroundCutter cutter = runOf(ValidJob(job), read).cutter();
    for (int k = 0; k < kPoints; ++k) {
      const double x = uniform(0, 0.022);
      const double r = uniform(0.6, 1) * 0.005;
      const auto arc = cutter.arc(cutter.flutes().front(), x, r);
      // About one of the ends.
      const double end = !arc ? cutter.section(x).teeth.front().edge.value() : k % 2 == 0 ? arc->low : arc->high;
      const double theta = end + uniform(-1, 1) * (k % 3 == 0 ? 0.5 : 0.005);
      const bool is = removed(cutter, x, r, theta);
      taken += is;
      if (is) {
        EXPECT_TRUE(removed(job, read, x, r, theta, kMargin)) << i << " x " << x << " r " << r << " theta " << theta;
      } else {
        EXPECT_FALSE(removed(job, read, x, r, theta, -kMargin)) << i << " x " << x << " r " << r << " theta " << theta;
      }
    }
  }
  EXPECT_GT(taken, kCases * kPoints / 10);
}

TEST(RunStrokes, AStrokeIsLeftOutOnlyIfAnotherCoversIt) {
  const GrindJob job = straight();
  const auto flutes = [&](int pass, const Axes& error) {
    return runOf(job, errorOf(pass, MoveKind::kStroke, error)).cutter().flutes().front().size();
  };
  const double little = 0.8 * RunStrokes::kSame, more = 1.2 * RunStrokes::kSame;
  EXPECT_EQ(flutes(2, along(kZ, little)), 1u);
  EXPECT_EQ(flutes(2, along(kZ, more)), 2u);
  EXPECT_EQ(flutes(2, along(kA, little / 0.005)), 1u);
  EXPECT_EQ(flutes(2, along(kA, -more / 0.005)), 2u);
  EXPECT_EQ(flutes(5, along(kY, -little)), 1u);
  EXPECT_EQ(flutes(5, along(kY, -more)), 2u);
  EXPECT_EQ(flutes(2, along(kY, -1e-4)), 1u);
}

Gouge onlyGouge(const GrindJob& job, const Error& error) {
  const std::vector<Gouge> gouges = gougesOf(runOf(job, error), 2e-6);
  EXPECT_EQ(gouges.size(), 1u);
  return gouges.empty() ? Gouge{} : gouges.front();
}

TEST(Gouges, TellTheMoveTheDepthAndThePlace) {
  const GrindJob job = straight();
  const std::vector<double> depths = passDepths(job.process());
  const double deep = depths.front() + 1.6e-3 - depths.back();
  const Error there = [](const Setpoint& p) {
    const bool is = p.pass == 3 && p.move == MoveKind::kStroke && std::abs(p.position[kX] - 7.7e-3) < 0.4e-3;
    return is ? along(kY, -1.6e-3) : Axes(Axes::Zero());
  };
  // Y hangs after the third pass; A turns by a quarter meanwhile.
  const Error hanging = [](const Setpoint& p) {
    const bool is = p.pass == 2 && p.move == MoveKind::kRetract;
    return is ? Axes(0, -1.2e-3 - p.position[kY], 0, p.move_fraction * kPi / 2) : Axes(Axes::Zero());
  };
  const struct {
    Error error;
    int pass;
    MoveKind move;
    double least, most;            ///< depth
    double from = -0.1, to = 0.1;  ///< X
  } rows[]{{errorOf(5, MoveKind::kStroke, along(kY, -1e-4)), 5, MoveKind::kStroke, 1e-4 - 1e-7, 1e-4 + 1e-7},
           {errorOf(5, MoveKind::kStroke, along(kZ, 3e-4)), 5, MoveKind::kStroke, 3e-4 - 1e-7, 3e-4 + 1e-7},
           {errorOf(0, MoveKind::kStroke, along(kY, -1.6e-3)), 0, MoveKind::kStroke, deep - 1e-7, deep + 1e-7},
           {there, 3, MoveKind::kStroke, 0.9e-3, 1.6e-3, 7.1e-3, 8.3e-3},
           {errorOf(5, MoveKind::kInfeed, along(kZ, 2e-4)), 5, MoveKind::kInfeed, 2e-4 - 5e-6, 2e-4 + 5e-6, 0, 0},
           {errorOf(2, MoveKind::kRetract, along(kA, 0.1)), 2, MoveKind::kRetract, 2e-4, 1e-3},
           {hanging, 2, MoveKind::kRetract, 1e-3, 6e-3}};
  for (const auto& row : rows) {
    SCOPED_TRACE(&row - rows);
    const Gouge gouge = onlyGouge(job, row.error);
    EXPECT_EQ(gouge.place, (ToothPass{0, row.pass}));
    EXPECT_EQ(gouge.move, row.move);
    EXPECT_GE(gouge.depth, row.least);
    EXPECT_LE(gouge.depth, row.most);
    EXPECT_GE(gouge.x, row.from);
    EXPECT_LE(gouge.x, row.to);
  }
}

// Its walls are so curved that a shallower pass lies far inside of them, but beyond their tangent.
TEST(Gouges, AShallowerPassIsNone) {
  const auto of_one_tooth = [](const char* file) {
    GrindJob job = readJobFile(file);
    job.tooth_angles = {0};
    return job;
  };
  for (const char* file : {"jobs/paper.yaml", "jobs/taper_d6_t6.yaml", "jobs/mould_cone_d2_t2.yaml"}) {
    EXPECT_TRUE(gougesOf(runOf(of_one_tooth(file), kExact), 1e-6).empty()) << file;
  }
  const GrindJob job = of_one_tooth("jobs/left_hand_d8_t3.yaml");
  EXPECT_TRUE(gougesOf(runOf(job, kExact), 1e-6).empty());
  EXPECT_NEAR(onlyGouge(job, errorOf(4, MoveKind::kStroke, along(kY, -1e-4))).depth, 1e-4, 1e-7);
}

// After a stop in the stroke it goes on a little before; the first part was deeper there.
TEST(RunStrokes, AStrokeThatWasBrokenOffCountsInBothParts) {
  const GrindJob job = straight();
  std::vector<Read> read = readOf(ValidJob(job), kExact);
  const auto in_last = [](const Read& r) { return r.setpoint.pass == 5 && r.setpoint.move == MoveKind::kStroke; };
  const auto from =
      std::find_if(read.begin(), read.end(), [&](const Read& r) { return in_last(r) && r.at[kX] > 9e-3; });
  const auto to = std::find_if(from, read.end(), [&](const Read& r) { return r.at[kX] > 10e-3; });
  std::vector<Read> with_lift(read.begin(), from);
  for (auto i = from; i != to; ++i) with_lift.push_back({i->setpoint, i->at + along(kY, -1e-4)});
  Read lift = *std::prev(to);
  lift.setpoint.move = MoveKind::kLift;
  lift.at[kY] += 0.01;
  with_lift.push_back(lift);
  with_lift.insert(with_lift.end(), from, read.end());
  for (std::size_t i = 0; i < with_lift.size(); ++i) with_lift[i].setpoint.cycle = i + 1;
  const GroundCutter cutter = runOf(ValidJob(job), with_lift).cutter();
  EXPECT_NEAR(coreAt(groundCutterOf(ValidJob(job)), 9.5e-3) - coreAt(cutter, 9.5e-3), 1e-4, 1e-7);
}

/// Both reliefs of the shipped reamer, with one tooth.
ValidJob reliefOf(const char* operation) {
  GrindJob job = readJobFile("jobs/taper_reamer_d6_t6.yaml", operation);
  job.tooth_angles = {0};
  return withLaws(ValidJob(job));
}

RunStrokes runOf(const ValidJob& relief, std::optional<GroundCutter> before, const Error& error) {
  return runOf(relief, readOf(relief, error), std::move(before));
}

ReliefSection reliefAt(const GroundCutter& cutter, double x) { return cutter.section(x).teeth.front().relief.value(); }

// Neither of the last two passes covers the other: each was deeper on one half.
TEST(RunStrokes, AReliefOfSeveralStrokesIsWhatTheyLeaveTogether) {
  constexpr double kDeeper = 4e-6, kHigher = 4e-6;
  const ValidJob primary = reliefOf("primary");
  const int last = static_cast<int>(primary.depths().size()) - 1;
  const double finishing = primary.depths()[last] - primary.depths()[last - 1];
  const Error halves = [&](const Setpoint& p) {
    const bool beyond = p.position[kX] > 8e-3;
    if (p.pass == last) return along(kY, beyond ? kHigher : 0);
    // As deep as the last one, and more.
    if (p.pass == last - 1) return along(kY, beyond ? -finishing - kDeeper : 0);
    return Axes(Axes::Zero());
  };
  const GroundCutter planned = groundCutterOf(primary);
  const GroundCutter cutter = runOf(primary, std::nullopt, halves).cutter();
  ASSERT_EQ(cutter.reliefs(0).size(), 1u);
  EXPECT_GT(cutter.reliefs(0).front().size(), 1u);
  const auto lower = [&](double x) {
    const double r = cutter.section(x).radius * (1 - 2e-3);
    const auto height = [&](const GroundCutter& of) {
      return outermostWall(of.reliefs(0).front(), x, r, false)->angle;
    };
    return (height(planned) - height(cutter)) * r * std::tan(primary->cutter.clearance);
  };
  EXPECT_NEAR(lower(1e-3), 0, 0.1e-6);
  EXPECT_NEAR(lower(14e-3), kDeeper, 0.3e-6);
  EXPECT_NEAR(cutter.section(14e-3).radius - reliefAt(cutter, 14e-3).edge_radius, kDeeper, 0.2e-6);
}

}  // namespace test_run_strokes
}  // namespace grinder
