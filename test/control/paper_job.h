#pragma once

#include "control/checks.h"
#include "control/rig.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// The paper's job: its dimensions, its planned setpoints, and checks of the path.
namespace grinder::test_support {

// D1 = 10 mm, C = 5 degrees, S = 30 degrees, rake 8 degrees, 30 mm with 1 and 7 mm of overtravel, 1.6 mm deep,
// 5 mm of clearance, 600 mm/min. The helix is A = (k/b) ln(1 + bX), with b = 2 tan C / D1 and k = 2 tan S / D1.
const double kDegree = std::acos(-1.0) / 180;
const double kTanCone = std::tan(5 * kDegree);
const double kB = 2 * kTanCone / 0.010;
const double kK = 2 * std::tan(30 * kDegree) / 0.010;
const double kClearanceHeight = 0.037 * kTanCone + 0.005;
const double kLift = kClearanceHeight + 0.001 * kTanCone + 0.0016;  // from its deepest point
const double kStrokeTo = 0.037;

inline SetpointStream paperFromPark() {
  const LoopConfig config = machineConfig();
  return paperStream(config.machine, config.machine.park);
}

/// The job's setpoints without interference.
inline const std::vector<Setpoint>& planned() {
  static const std::vector<Setpoint> all = allSetpoints(paperFromPark());
  return all;
}

/// Cycles of a planned move, and the position before the first.
struct Span {
  std::uint64_t first, last;
  Axes from, to;
};

inline Span spanOf(MoveKind move) {
  const auto is_of = [=](const Setpoint& p) { return p.cycle > 0 && p.move == move; };
  const auto first = std::find_if(planned().begin(), planned().end(), is_of);
  const auto last = std::find_if(planned().rbegin(), planned().rend(), is_of);
  return {first->cycle, last->cycle, (first - 1)->position, last->position};
}

/// A moment of the paper's job.
struct Moment {
  MoveKind move;
  int per_mille;  ///< of the move's cycles
  bool mid_pair;  ///< between the two steps of a pair

  std::uint64_t cycle() const {
    const Span span = spanOf(move);
    const std::uint64_t at = span.first + (span.last - span.first) * static_cast<std::uint64_t>(per_mille) / 1000;
    return (at + 1) / 2 * 2 + (mid_pair ? 1 : 0);
  }
};
inline std::ostream& operator<<(std::ostream& out, const Moment& m) {
  return out << toString(m.move) << " " << m.per_mille;
}

inline std::string momentName(const testing::TestParamInfo<Moment>& info) {
  return std::string(toString(info.param.move)) + "_" + std::to_string(info.param.per_mille) +
         (info.param.mid_pair ? "_mid_pair" : "_pair_end");
}

inline std::vector<Moment> moments(const std::vector<int>& per_mille) {
  std::vector<Moment> all;
  for (const MoveKind move : {MoveKind::kIndex, MoveKind::kPosition, MoveKind::kApproach, MoveKind::kInfeed,
                              MoveKind::kStroke, MoveKind::kRetract, MoveKind::kReturn}) {
    for (const int at : per_mille) {
      for (const bool mid_pair : {false, true}) all.push_back({move, at, mid_pair});
    }
  }
  return all;
}

/// Whether a setpoint lies on the job's path: on the straight line of its move, or on the helix, within 1 um across it
/// at the cutter's surface.
inline testing::AssertionResult onPath(const Setpoint& p) {
  const auto failure = [&] {
    return testing::AssertionFailure() << "cycle " << p.cycle << " in " << toString(p.move) << ": "
                                       << p.position.transpose();
  };
  if (p.cycle == 0) return testing::AssertionSuccess();
  if (p.move == MoveKind::kStroke) {
    const double x = p.position[kX];
    const double radius = 0.005 + x * kTanCone;
    const double off_a = p.position[kA] - kK / kB * std::log1p(kB * x);
    if (!(std::abs(off_a) * radius * std::cos(30 * kDegree) <= 1.01e-6)) return failure() << " is off the helix";
    if (!(std::abs(p.position[kY] - (x * kTanCone - 0.0016)) <= 1e-12)) return failure() << " is off in Y";
    if (!(std::abs(p.position[kZ] - x * kTanCone * std::sin(8 * kDegree)) <= 1e-12)) return failure() << " is off in Z";
    return testing::AssertionSuccess();
  }
  const Span span = spanOf(p.move);
  const Axes way = span.to - span.from;
  const double done = ((p.position - span.from) * way).sum() / (way * way).sum();
  if (!(done >= -1e-9 && done <= 1 + 1e-9)) return failure() << " is beyond its move";
  // After the stroke A starts where the odd-even steps ended.
  const Axes off = (p.position - span.from - done * way).abs();
  const double a_tolerance = p.move == MoveKind::kRetract ? 1e-6 / (0.008 * std::cos(30 * kDegree)) : 1e-12;
  if (!((off.head<3>() <= 1e-12).all() && off[kA] <= a_tolerance)) return failure() << " is off its straight";
  return testing::AssertionSuccess();
}

/// Expects that a job was completed as if nobody had interfered.
template <typename Drive>
inline void expectCompleted(const Rig<Drive>& rig) {
  EXPECT_EQ(rig.last().state, S::kReady);
  EXPECT_EQ(rig.jobsEnded(), 1);
  EXPECT_EQ(rig.last().fault.kind, FaultKind::kNone) << rig.last().fault.text();
  EXPECT_EQ(rig.last().interlock, Interlock::kNone);
  EXPECT_TRUE((rig.last().command == machineConfig().machine.park).all()) << rig.last().command.transpose();
  EXPECT_TRUE(smooth(rig.log));
  const auto setpoints = rig.setpoints();
  const bool ground = std::any_of(setpoints.begin(), setpoints.end(), [](const Setpoint& p) {
    return p.move == MoveKind::kStroke && p.position[kX] == kStrokeTo;
  });
  EXPECT_TRUE(ground) << "the stroke's end was not ground";
}

}  // namespace grinder::test_support
