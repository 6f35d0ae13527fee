#include "flute_grinder/curve/step_table.h"

#include "curve/generators.h"
#include "reference.h"

#include <gtest/gtest.h>

#include <cmath>

namespace grinder {
namespace test_step_table {

using namespace test_support;

constexpr double kMm = units::kMillimetre;

/// As the paper counts: X in mm, A in rad.
StepTable tableOf(const Cone& cutter, EvenStepRule rule, double step_length) {
  return interpolateBySteps(ConicalCutter(cutter), units::kMillimetrePerRadian, rule, step_length);
}

StepTable papersTable(double step_length) { return tableOf(paperCone(), EvenStepRule::kPublished, step_length); }

/// A row of the paper's Table 1, as printed.
struct TableRow {
  int point;
  double x_mm, a, theory, error_e4;
};

constexpr TableRow kTable1[]{
    {0, 0, 0, 0, 0},
    {1, 0.1987, 0.0229, 0.0229, -0.3979},
    {2, 0.3974, 0.0457, 0.0457, -0.0001},
    {3, 0.5961, 0.0685, 0.0685, -0.3926},
    {4, 0.7948, 0.0911, 0.0911, -0.0002},
    {5, 0.9935, 0.1138, 0.1137, -0.3874},
    {6, 1.1922, 0.1363, 0.1363, -0.0003},
    {7, 1.3910, 0.1587, 0.1587, -0.3823},
    {8, 1.5897, 0.1811, 0.1811, -0.0004},
    {9, 1.7885, 0.2034, 0.2033, -0.3773},
    {143, 28.4736, 2.6679, 2.6679, -0.1829},
    {144, 28.6730, 2.6833, 2.6833, -0.0034},
    {145, 28.8724, 2.6986, 2.6986, -0.1813},
    {146, 29.0718, 2.7138, 2.7138, -0.0035},
    {147, 29.2713, 2.7291, 2.7291, -0.1797},
    {148, 29.4707, 2.7443, 2.7443, -0.0035},
    {149, 29.6701, 2.7595, 2.7595, -0.1781},
    {150, 29.8695, 2.7746, 2.7746, -0.0035},
    {151, 30.0689, 2.7897, 2.7897, -0.1765},
    {152, 30.2684, 2.8048, 2.8048, -0.0035},
};

/// As the table prints: four decimals.
double printed(double value) { return std::round(value * 1e4) / 1e4; }

TEST(StepTable, GivesThePapersTable1ToThePrintedDigit) {
  const StepTable table = papersTable(0.2 * kMm);
  const ReferenceCurve curve(paperCone());
  for (const TableRow& printed_row : kTable1) {
    SCOPED_TRACE(printed_row.point);
    ASSERT_LT(static_cast<std::size_t>(printed_row.point), table.rows.size());
    const StepTable::Row& row = table.rows[static_cast<std::size_t>(printed_row.point)];
    EXPECT_NEAR(printed(row.point.x / kMm), printed_row.x_mm, 1e-9);
    EXPECT_NEAR(printed(row.point.a), printed_row.a, 1e-9);
    EXPECT_NEAR(printed(row.theory), printed_row.theory, 1e-9);
    EXPECT_NEAR(printed(row.error() * 1e4), printed_row.error_e4, 1e-9);
    EXPECT_NEAR(row.theory, static_cast<double>(curve.a(row.point.x)), 1e-15);
  }
  EXPECT_TRUE(table.complete);
  EXPECT_EQ(table.rows.size() - 1, 152u);
  EXPECT_NEAR(table.max_odd_error, 3.9785e-5, 0.00005e-5);
  EXPECT_NEAR(table.max_even_error, 3.5000e-7, 0.00005e-7);
  EXPECT_EQ(table.maxError(), table.max_odd_error);
}

TEST(StepTable, HasThePapersFiguresForTheLongerStep) {
  const StepTable table = papersTable(0.5 * kMm);
  EXPECT_EQ(table.rows.size() - 1, 62u);
  EXPECT_NEAR(table.rows.back().point.x / kMm, 30.8667, 0.00005);
  EXPECT_NEAR(table.maxError(), 2.4780e-4, 0.00005e-4);
}

TEST(StepTable, TakesTheRuleThatItIsGiven) {
  const StepTable exact = tableOf(paperCone(), EvenStepRule::kExact, 0.2 * kMm);
  EXPECT_TRUE(exact.complete);
  EXPECT_LE(exact.max_even_error, 2e-15);
}

// The sum of its steps is less than the length of the flute by the last bit.
TEST(StepTable, EndsWithThePairThatEndsAtTheFlutesEnd) {
  const Cone straight{10 * kMm, 0, 0, 0, 9.4 * kMm};
  const StepTable table = tableOf(straight, EvenStepRule::kPublished, 0.05 * kMm);
  EXPECT_EQ(table.rows.size() - 1, 188u);
  EXPECT_NEAR(table.rows.back().point.x, 9.4 * kMm, 1e-15);
}

TEST(StepTable, EndsWhereTheStepsAreTooLongForTheCurve) {
  // A back taper whose cone closes within the first step.
  const Cone back{10 * kMm, -3 * units::kDegree, 30 * units::kDegree, 0, 30 * kMm};
  const StepTable table = tableOf(back, EvenStepRule::kPublished, 100 * kMm);
  EXPECT_FALSE(table.complete);
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows.front().point.x, 0);
  // The cone closes at 95 mm: the first step of a pair ends before, the second one behind it.
  const StepTable half = tableOf(back, EvenStepRule::kPublished, 75 * kMm);
  EXPECT_FALSE(half.complete);
  EXPECT_EQ(half.rows.size(), 1u);
  // A first step that ends behind the apex, and a second one that comes back.
  const Cone steep{2 * kMm, -3 * units::kDegree, 40 * units::kDegree, 0, 10 * kMm};
  const ReferenceCurve curve(steep);
  const ReferencePair pair = test_support::publishedPair(curve, units::kMillimetrePerRadian, 0, 26 * kMm);
  ASSERT_LT(curve.u(pair.x1), 0);
  ASSERT_GT(curve.u(pair.x2), 0);
  const StepTable back_again = tableOf(steep, EvenStepRule::kPublished, 26 * kMm);
  EXPECT_FALSE(back_again.complete);
  EXPECT_EQ(back_again.rows.size(), 1u);
}

TEST(StepTable, EndsWhereAStepLeadsNowhere) {
  for (const double step_length : {0.0, -0.2 * kMm, std::nan("")}) {
    const StepTable table = papersTable(step_length);
    EXPECT_FALSE(table.complete) << step_length;
    EXPECT_EQ(table.rows.size(), 1u) << step_length;
  }
}

}  // namespace test_step_table
}  // namespace grinder
