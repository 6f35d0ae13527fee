#pragma once

#include "control/checks.h"
#include "control/rig.h"

#include <algorithm>
#include <cmath>
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
