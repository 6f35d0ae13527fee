#include "drive/simulated_bench.h"

#include <cmath>
#include <functional>

// What the simulated drive's probe touches.
namespace grinder::test_support {
namespace test_simulated_probe {

constexpr double kBall = 0.001;

/// The ball stands on the axis of the work spindle, 60 mm before the blank's end face, with the axes at zero.
SimulatedDrive::Blank blank() {
  SimulatedDrive::Blank blank;
  blank.end_face = 0.06;
  blank.diameter = 0.01;
  blank.ball_diameter = kBall;
  return blank;
}

/// Whether the probe touches with the axes at a place.
bool touches(const SimulatedDrive::Blank& blank, const Axes& at) {
  Bench bench(plainModel(0));
  bench.drive.clamp(blank);
  bench.asked.enable = true;
  for (int axis = 0; axis < kAxisCount; ++axis) bench.command(axis, at[axis]);
  bench.run(3);
  return bench.status().probe_contact;
}

/// The place between two at which the probe begins to touch; it does so at the second.
double edge(double free, double touching, const std::function<bool(double)>& touches_at) {
  EXPECT_FALSE(touches_at(free));
  EXPECT_TRUE(touches_at(touching));
  while (std::abs(touching - free) > 1e-10) {
    const double middle = (free + touching) / 2;
    (touches_at(middle) ? touching : free) = middle;
  }
  return touching;
}

TEST(SimulatedProbe, WithoutABlankItTouchesNothing) {
  Bench bench;
  bench.run(3);
  EXPECT_FALSE(bench.status().probe_contact);
}

TEST(SimulatedProbe, TouchesTheEndFaceBeforeItsCentreIsThere) {
  const auto at = [](double y) { return edge(0, 0.07, [y](double x) { return touches(blank(), Axes(x, y, 0, 0)); }); };
  EXPECT_NEAR(at(0), 0.0595, 1e-9);
  EXPECT_NEAR(at(0.005), 0.0595, 1e-9);
  // Over the face's edge, by 0.3 of the ball's 0.5 mm.
  EXPECT_NEAR(at(0.0053), 0.0596, 1e-9);
  EXPECT_FALSE(touches(blank(), Axes(0.07, 0.00551, 0, 0)));
}

TEST(SimulatedProbe, TouchesTheCylinder) {
  const auto from = [](double z) {
    return edge(0.02, 0, [z](double y) { return touches(blank(), Axes(0.1, y, z, 0)); });
  };
  EXPECT_NEAR(from(0), 0.0055, 1e-9);
  EXPECT_NEAR(from(0.0033), 0.0044, 1e-9);
  EXPECT_NEAR(from(-0.0033), 0.0044, 1e-9);
}

TEST(SimulatedProbe, TheRunOutTurnsWithTheWork) {
  SimulatedDrive::Blank eccentric = blank();
  eccentric.run_out = 2e-4;
  const auto at = [&](double a) {
    return edge(0.02, 0, [&](double y) { return touches(eccentric, Axes(0.1, y, 0, a)); });
  };
  EXPECT_NEAR(at(0), 0.0056, 1e-9);
  EXPECT_NEAR(at(M_PI), 0.0054, 1e-9);
  EXPECT_NEAR(at(M_PI / 2), std::sqrt(0.0055 * 0.0055 - 1e-8), 1e-9);
}

TEST(SimulatedProbe, TheRakeFaceComesDownAsATurns) {
  SimulatedDrive::Blank tooth = blank();
  tooth.rake_face = {0.001, 0.3};
  // At radius 4.5 mm, the plane at 1 mm less the ball's radius: sin(A - 0.3) = 0.5 / 4.5.
  const double angle = edge(-0.5, 0.6, [&](double a) { return touches(tooth, Axes(0.1, 0.0045, 0, a)); });
  EXPECT_NEAR(angle, 0.3 + std::asin(0.5 / 4.5), 1e-9);
  EXPECT_TRUE(touches(tooth, Axes(0.1, 0.0045, 0, M_PI / 2))) << "in the half that is left";
}

/// In a single reading each time that it comes within 0.2 mm, as through a film of coolant.
TEST(SimulatedProbe, ThatFlickersTouchesBeforeTheSurfaceToo) {
  Bench bench(plainModel(0));
  bench.drive.clamp(blank());
  bench.drive.inject(SimulatedDrive::Fault::kProbeFlickers);
  bench.asked.enable = true;
  const auto touches_at = [&](double x) {
    bench.command(kX, x);
    bench.run(1);
    return bench.status().probe_contact;
  };
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(touches_at(0.05925));
    EXPECT_TRUE(touches_at(0.05935));
    EXPECT_FALSE(touches_at(0.0594));
  }
  EXPECT_TRUE(touches_at(0.0596));
}

}  // namespace test_simulated_probe
}  // namespace grinder::test_support
