// What measured tools say of a set-up, against the edge circle of the paper's wheel in closed form, and in batches of
// tools on a machine with errors of its own.

#include "flute_grinder/setup/setup_estimate.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/z_law.h"

#include "jobs.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grinder {
namespace test_setup_estimate {

using Eigen::Index;
using Eigen::VectorXd;
using units::kDegree;
using units::kMicrometre;
using units::kMillimetre;

constexpr int kBatch = 30;
constexpr double kWear = 1.2 * kMicrometre;  ///< by a tool
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

const ValidJob& paper() {
  static const ValidJob job = withLaws(ValidJob(test_support::jobOf("paper")));
  return job;
}

/// Rake at 2, 15 and 28 mm, core at 2 and 28 mm.
const FigureModel& model() {
  static const FigureModel model = figureModel(paper(), {{ToolFigure::kRake, 2 * kMillimetre},
                                                         {ToolFigure::kRake, 15 * kMillimetre},
                                                         {ToolFigure::kRake, 28 * kMillimetre},
                                                         {ToolFigure::kCoreDiameter, 2 * kMillimetre},
                                                         {ToolFigure::kCoreDiameter, 28 * kMillimetre}});
  return model;
}

/// 0.08 deg, 2 um.
VectorXd gauge() {
  VectorXd gauge(5);
  gauge << 0.08 * kDegree, 0.08 * kDegree, 0.08 * kDegree, 2 * kMicrometre, 2 * kMicrometre;
  return gauge;
}

Turns turns(double y, double z, double swivel) {
  Turns turns = Turns::Zero();
  turns.head<3>() << y, z, swivel;
  return turns;
}

const Turns kMost = turns(5 * kMillimetre, 5 * kMillimetre, 5 * kDegree);

/// A machine that is off by unknown errors, whose wheel wears, and which does as it is told.
class ShopMachine {
 public:
  explicit ShopMachine(unsigned seed) : random_(seed) {
    off_ = turns(normal(10 * kMicrometre), normal(12 * kMicrometre), normal(0.08 * kDegree));
  }
  void wearWheel() { off_[0] += kWear; }
  void turn(const Turns& by) { off_ += by; }
  const Turns& off() const { return off_; }
  VectorXd gauged(VectorXd figures) {
    for (Index i = 0; i < figures.size(); ++i) figures[i] += normal(gauge()[i]);
    return figures;
  }

 private:
  double normal(double spread) { return std::normal_distribution<double>(0, spread)(random_); }

  std::mt19937 random_;
  Turns off_;
};

/// What a batch does about a measured tool: says by how much to turn.
using Shop = std::function<Turns(const VectorXd& measured)>;

Shop corrected() {
  SetupEstimate estimate(usualSpread());
  return [estimate](const VectorXd& measured) mutable {
    estimate.nextTool();
    if (estimate.take(model(), measured, gauge())) return Turns(Turns::Zero());
    const Turns by = correctionOf(model(), estimate.expected(), kMost).turn;
    estimate.turn(by);
    return by;
  };
}

/// The page's old rule: half of the core's error.
Turns byCoreAlone(const VectorXd& measured) {
  return turns(-(measured[3] - model().planned[3]) / model().slope(3, 0), 0, 0);
}

/// A tool's figures on a machine that is off.
VectorXd linear(const Turns& off) { return model().planned + model().slope * off; }

/// @return how many tools of a batch are out of tolerance.
template <typename IsGood>
int outOf(unsigned seed, const Shop& shop, const std::function<VectorXd(const Turns&)>& grind, const IsGood& isGood) {
  ShopMachine machine(seed);
  int out = 0;
  for (int i = 0; i < kBatch; ++i) {
    machine.wearWheel();
    const VectorXd figures = grind(machine.off());
    if (!isGood(figures, machine.off())) ++out;
    machine.turn(shop(machine.gauged(figures)));
  }
  return out;
}

/// Mean over 200 batches, by the linear model.
double meanOut(const std::function<Shop()>& shop) {
  const auto good = [](const VectorXd& figures, const Turns&) {
    return ((figures - model().planned).array().abs() <= model().tolerance.array()).all();
  };
  int out = 0;
  for (unsigned seed = 0; seed < 200; ++seed) out += outOf(seed, shop(), linear, good);
  return out / 200.0;
}

TEST(SetupTurns, MoveTheFiguresAsTheEdgeCircleDoes) {
  // The upper edge's circle in closed form, of the shipped set-up: deg and mm, per mm and deg.
  const double edge_circle[5][5]{{-29.4, -20.7, -1.4, 12, 2.3},
                                 {-26.9, -18.1, -2.2, 22, 1.9},
                                 {-25.1, -16.1, -2.9, 31, 1.6},
                                 {1.865, 0.72, -0.07, -0.41, 0},
                                 {1.882, 0.68, -0.06, -2.01, 0}};
  const double digits[5]{0.07, 0.05, 0.05, 0.5, 0.05}, digits_of_core[5]{0.001, 0.005, 0.005, 0.006, 1e-6};
  for (Index i = 0; i < 5; ++i) {
    for (Index turn = 0; turn < kSetupTurnCount; ++turn) {
      const double per = turn == indexOf(SetupTurn::kSwivel) ? kDegree : kMillimetre;
      const double slope = model().slope(i, turn) * per / (i < 3 ? kDegree : kMillimetre);
      EXPECT_NEAR(slope, edge_circle[i][turn], i < 3 ? digits[turn] : digits_of_core[turn]) << i << " by " << turn;
    }
  }
}

TEST(SetupTurns, RefuseAFigureThatNothingIsSetBy) {
  EXPECT_THROW(figureModel(paper(), {{ToolFigure::kLand, 15 * kMillimetre}}), std::invalid_argument);
  EXPECT_THROW(figureModel(paper(), {{ToolFigure::kClearance, 15 * kMillimetre}}), std::invalid_argument);
}

/// A relief of the shipped end mill: rake 8 deg, clearances 10 and 20 deg.
ValidJob reliefOf(const char* operation) {
  return withLaws(ValidJob(readJobFile("jobs/end_mill_d10_t4.yaml", operation)));
}

/// How fast a figure in the middle changes with a way of the wheel square to the axis, along which it changes fastest.
double steepest(const ValidJob& job, ToolFigure figure) {
  const FigureModel model = figureModel(job, {{figure, 11 * kMillimetre}});
  return std::hypot(model.slope(0, indexOf(SetupTurn::kY)), model.slope(0, indexOf(SetupTurn::kZ)));
}

TEST(SetupTurns, OfAReliefMoveTheEdgeAlongItsRakeFaceAndTheWidthOfThePrimaryAlongIt) {
  // Where a plane, shifted square to itself, cuts another one.
  EXPECT_NEAR(steepest(reliefOf("primary"), ToolFigure::kEdgeDiameter),
              2 * std::cos(8 * kDegree) / std::cos(18 * kDegree), 0.03);
  EXPECT_NEAR(steepest(reliefOf("secondary"), ToolFigure::kPrimary), 1 / std::sin(10 * kDegree), 0.15);
}

TEST(SetupTurns, AreFoundForAReliefThatIsTooDeepAndThePrimaryThatIsTooNarrow) {
  const std::pair<const char*, ToolFigure> judged[]{{"primary", ToolFigure::kEdgeDiameter},
                                                    {"secondary", ToolFigure::kPrimary}};
  for (const auto& [operation, figure] : judged) {
    SCOPED_TRACE(operation);
    const ValidJob job = reliefOf(operation);
    const std::vector<FigureAt> figures = judgedFigures(*job);
    const FigureModel model = figureModel(job, figures);
    Turns off = turns(-8 * kMicrometre, -6 * kMicrometre, 0);
    const VectorXd before = figuresOffBy(job, figures, off);
    SetupEstimate estimate(usualSpread());
    for (int tool = 0; tool < 3; ++tool) {
      estimate.nextTool();
      EXPECT_FALSE(estimate.take(model, before, VectorXd::Constant(before.size(), 1e-7)));
    }
    off += correctionOf(model, estimate.error(), kMost).turn;
    const VectorXd after = figuresOffBy(job, figures, off);
    for (std::size_t i = 0; i < figures.size(); ++i) {
      if (figures[i].figure != figure) continue;
      const auto row = static_cast<Index>(i);
      EXPECT_GT(std::abs(before[row] - model.planned[row]), model.tolerance[row]) << i;
      EXPECT_LT(std::abs(after[row] - model.planned[row]), 0.2 * model.tolerance[row]) << i;
    }
  }
}

TEST(SetupTurns, OfAReliefDoByATurnOfAWhatZDoes) {
  // Both move the wheel along the surface that it grinds: to turn A as well would set nothing that Y and Z cannot.
  const FigureModel model = figureModel(
      reliefOf("primary"), {{ToolFigure::kClearance, 11 * kMillimetre}, {ToolFigure::kEdgeDiameter, 11 * kMillimetre}});
  const VectorXd a = model.slope.col(indexOf(SetupTurn::kShift)), z = model.slope.col(indexOf(SetupTurn::kZ));
  EXPECT_NEAR(a[0] / z[0], a[1] / z[1], 0.01);
  // Half a millimetre moves the clearance by less than its tolerance, and no touch-off is off by that much.
  EXPECT_LT(std::abs(z[0]) * 0.5 * kMillimetre, model.tolerance[0]);
}

TEST(SetupEstimate, SetsNothingByAClearanceThatIsOffAlone) {
  for (const char* operation : {"primary", "secondary"}) {
    const ValidJob job = reliefOf(operation);
    const FigureModel model = figureModel(job, judgedFigures(*job));
    VectorXd measured = model.planned;
    measured.head<3>().array() += model.tolerance[0];
    VectorXd spread(measured.size());
    for (Index i = 0; i < spread.size(); ++i) spread[i] = gauge()[i < 3 ? 0 : 3];
    SetupEstimate estimate(usualSpread());
    for (int tool = 0; tool < 3; ++tool) {
      estimate.nextTool();
      EXPECT_TRUE(estimate.take(model, measured, spread)) << operation;
    }
    EXPECT_EQ(estimate.error(), Turns::Zero());
  }
}

/// The tool that the paper's job grinds on a machine that is off: the job itself is changed, so that nothing of the
/// model under test is used.
GroundCutter toolOff(const Turns& off) {
  GrindJob job = *paper();
  GrindProcess& p = job.process();
  p.depth -= off[0];
  p.depth_end -= off[0];
  p.setup_height += off[1];
  p.setup_swivel += off[2];
  return groundCutterOf(withLaws(ValidJob(job)));
}

double rakeAt(const GroundCutter& tool, double x) { return tool.section(x).teeth[0].rake.value(); }
double coreAt(const GroundCutter& tool, double x) { return 2 * tool.section(x).core_radius; }

VectorXd grind(const Turns& off) {
  const GroundCutter tool = toolOff(off);
  VectorXd figures(5);
  figures << rakeAt(tool, 2e-3), rakeAt(tool, 15e-3), rakeAt(tool, 28e-3), coreAt(tool, 2e-3), coreAt(tool, 28e-3);
  return figures;
}

/// Against what the job asks, over the whole flute.
bool isAsAsked(const Turns& off) {
  const GroundCutter tool = toolOff(off);
  const CutterGeometry& asked = paper()->cutter;
  bool good = true;
  for (const double x : {0.0, 7.5e-3, 15e-3, 22.5e-3, 30e-3}) {
    good = good && std::abs(rakeAt(tool, x) - 8 * kDegree) <= 0.5 * kDegree;
    good = good && std::abs(coreAt(tool, x) - askedCore(asked, x)) <= 0.02 * kMillimetre;
  }
  return good;
}

TEST(SetupEstimate, KeepsBatchesInTolerance) {
  EXPECT_GT(meanOut([] { return [](const VectorXd&) { return Turns(Turns::Zero()); }; }), 20);
  EXPECT_GT(meanOut([] { return byCoreAlone; }), 2);
  EXPECT_LT(meanOut(corrected), 1);
}

TEST(SetupEstimate, KeepsGroundToolsInTolerance) {
  const auto good = [](const VectorXd&, const Turns& off) { return isAsAsked(off); };
  int out = 0;
  for (unsigned seed = 0; seed < 2; ++seed) out += outOf(seed, corrected(), grind, good);
  EXPECT_LE(out, 2);
}

/// An estimate after some tools on a machine that is off by `off` and wears.
SetupEstimate after(int tools, Turns off) {
  SetupEstimate estimate(usualSpread());
  for (int i = 0; i < tools; ++i) {
    off[0] += kWear;
    estimate.nextTool();
    EXPECT_FALSE(estimate.take(model(), linear(off), gauge()));
  }
  return estimate;
}

TEST(SetupEstimate, FindsErrorsAndWear) {
  const Turns off = turns(15 * kMicrometre, -10 * kMicrometre, 0.1 * kDegree);
  const SetupEstimate estimate = after(20, off);
  EXPECT_NEAR(estimate.wear(), kWear, 0.1 * kMicrometre);
  EXPECT_NEAR(estimate.error()[0], off[0] + 20 * kWear, 2 * kMicrometre);
  EXPECT_NEAR(estimate.expected()[0] - estimate.error()[0], estimate.wear(), 1e-12);
}

TEST(SetupEstimate, WeighsAToolAsLeastSquaresDo) {
  SetupSpread spread = usualSpread();
  spread.noise.setZero();
  spread.wear = 0;
  SetupEstimate estimate(spread);
  VectorXd measured = model().planned + 1.3 * gauge();
  measured[1] = kNotMeasured;
  ASSERT_FALSE(estimate.take(model(), measured, gauge()));
  // The normal equations, of the turns that have a spread.
  Eigen::Matrix3d normal = spread.setup.head<3>().cwiseAbs2().cwiseInverse().asDiagonal();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Index i : {0, 2, 3, 4}) {
    const Eigen::Vector3d slope = model().slope.row(i).head<3>();
    normal += slope * slope.transpose() / (gauge()[i] * gauge()[i]);
    right += slope * 1.3 / gauge()[i];
  }
  const Eigen::Vector3d expected = normal.inverse() * right;
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(estimate.error()[i], expected[i], 1e-6 * std::abs(expected[i]));
  EXPECT_EQ(estimate.error().tail<2>(), Eigen::Vector2d::Zero());
}

TEST(SetupEstimate, IsNotMovedByAWrongEntry) {
  const auto check = [](int tools, Index figure, const std::function<double(double)>& wrong) {
    SetupEstimate estimate = after(tools, turns(8 * kMicrometre, -9 * kMicrometre, 0.05 * kDegree));
    estimate.nextTool();
    const Turns before = estimate.error();
    VectorXd measured = linear(estimate.error());
    measured[figure] = wrong(measured[figure]);
    const auto surprise = estimate.take(model(), measured, gauge());
    ASSERT_TRUE(surprise) << figure << " after " << tools;
    EXPECT_EQ(surprise->figure, figure);
    EXPECT_NEAR((surprise->allowed.from + surprise->allowed.to) / 2, linear(before)[figure], 1e-6);
    EXPECT_EQ(estimate.error(), before);
  };
  for (const int tools : {0, 8}) {
    check(tools, 3, [](double core) { return core + 0.1 * kMillimetre; });  // a wrong digit
    check(tools, 0, [](double rake) { return rake - 3 * kDegree; });
    check(tools, 3, [](double core) { return core / 1000; });  // mm for um
    check(tools, 4, [](double core) { return core * 1000; });
    check(tools, 3, [](double core) { return core / 2; });  // the radius for the diameter
    check(tools, 1, [](double rake) { return rake * kDegree; });
    check(tools, 1, [](double) { return std::numeric_limits<double>::infinity(); });
  }
  check(8, 3, [](double core) { return core + 0.02 * kMillimetre; });
  check(8, 4, [](double core) { return core - 0.02 * kMillimetre; });
}

TEST(Correction, TurnsTheErrorBackByYAndZ) {
  const Correction by = correctionOf(model(), turns(20 * kMicrometre, -15 * kMicrometre, 0), kMost);
  EXPECT_NEAR(by.turn[0], -20 * kMicrometre, kMicrometre);
  EXPECT_NEAR(by.turn[1], 15 * kMicrometre, 1.5 * kMicrometre);
  EXPECT_EQ(by.turn.tail<3>(), Eigen::Vector3d::Zero());
  EXPECT_FALSE(by.by_swivel);
  EXPECT_NEAR(by.now[3], (1.865 * 20 - 0.72 * 15) / 20, 0.01);  // tolerances of 20 um
  EXPECT_LT(by.after.cwiseAbs().maxCoeff(), 0.05);
}

TEST(Correction, TurnsTheSwivelForWhatYAndZLeave) {
  const Correction alone = correctionOf(model(), turns(0, 0, 0.4 * kDegree), turns(1, 1, 0));
  EXPECT_FALSE(alone.by_swivel);
  EXPECT_GT(alone.after.cwiseAbs().maxCoeff(), 0.5);
  const Correction by = correctionOf(model(), turns(0, 0, 0.4 * kDegree), kMost);
  EXPECT_TRUE(by.by_swivel);
  EXPECT_LT(by.after.cwiseAbs().maxCoeff(), 0.1);
}

TEST(Correction, StaysWithinItsLimits) {
  const Correction by = correctionOf(model(), turns(20 * kMicrometre, 0, 0), turns(5 * kMicrometre, kMicrometre, 0));
  EXPECT_EQ(by.turn[0], -5 * kMicrometre);
  EXPECT_EQ(by.turn[1], -kMicrometre);
  EXPECT_NEAR(by.after[3], (1.865 * 15 - 0.72) / 20, 0.01);
}

TEST(Correction, LeavesWhatIsNotWorthIt) {
  const Correction by = correctionOf(model(), turns(1.4 * kMicrometre, 0, 0), kMost);  // 0.13 of the core's tolerance
  EXPECT_TRUE(by.in_dead_band);
  EXPECT_EQ(by.turn, Turns::Zero());
  EXPECT_EQ(by.after, by.now);
  EXPECT_FALSE(correctionOf(model(), turns(2 * kMicrometre, 0, 0), kMost).in_dead_band);
}

TEST(Gauge, SeesAFifthOfATolerance) {
  EXPECT_TRUE(isSeen(ToolFigure::kCoreDiameter, 10.1 * kMicrometre));
  EXPECT_FALSE(isSeen(ToolFigure::kCoreDiameter, 9.9 * kMicrometre));
  EXPECT_TRUE(isSeen(ToolFigure::kRake, 0.41 * kDegree));
  EXPECT_FALSE(isSeen(ToolFigure::kRake, 0.39 * kDegree));
}

}  // namespace test_setup_estimate
}  // namespace grinder
