#pragma once

#include "control/checks.h"
#include "control/rig.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// The paper's job: its dimensions, its planned setpoints, and checks of its end.
namespace grinder::test_support {

// C = 5 degrees, 30 mm with 1 and 7 mm of overtravel, 1.6 mm deep, 5 mm of clearance.
const double kDegree = std::acos(-1.0) / 180;
const double kTanCone = std::tan(5 * kDegree);
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

constexpr MoveKind kAllMoves[]{MoveKind::kIndex,  MoveKind::kPosition, MoveKind::kApproach, MoveKind::kInfeed,
                               MoveKind::kStroke, MoveKind::kRetract,  MoveKind::kReturn};

/// A moment of the paper's job.
struct Moment {
  MoveKind move;
  int per_mille;  ///< of the move's cycles
  bool mid_pair;  ///< between the two steps of a pair

  std::uint64_t cycle() const {
    const auto is_of = [this](const Setpoint& p) { return p.cycle > 0 && p.move == move; };
    const std::uint64_t first = std::find_if(planned().begin(), planned().end(), is_of)->cycle;
    const std::uint64_t last = std::find_if(planned().rbegin(), planned().rend(), is_of)->cycle;
    const std::uint64_t at = first + (last - first) * static_cast<std::uint64_t>(per_mille) / 1000;
    return (at + 1) / 2 * 2 + (mid_pair ? 1 : 0);
  }
};
inline std::ostream& operator<<(std::ostream& out, const Moment& m) {
  return out << toString(m.move) << " " << m.per_mille << (m.mid_pair ? " mid-pair" : " at a pair's end");
}

inline std::vector<Moment> moments(const std::vector<int>& per_mille) {
  std::vector<Moment> all;
  for (const MoveKind move : kAllMoves) {
    for (const int at : per_mille) {
      for (const bool mid_pair : {false, true}) all.push_back({move, at, mid_pair});
    }
  }
  return all;
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

template <typename Drive>
inline void expectResumedAndCompleted(Rig<Drive>& rig) {
  ASSERT_TRUE(rig.ask(E::kResume).accepted);
  if (rig.jobsEnded() == 0) rig.runToEnd();
  expectCompleted(rig);
}

}  // namespace grinder::test_support
