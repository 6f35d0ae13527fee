#pragma once

#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/control/loop_config.h"
#include "flute_grinder/control/loop_status.h"
#include "flute_grinder/control/wheel_watch.h"
#include "flute_grinder/motion/axis_move.h"
#include "flute_grinder/motion/limit_check.h"

namespace grinder {

/// What the parts of the control loop share. For the control thread only; real-time safe except for the constructor.
struct LoopState {
  /// @throw std::invalid_argument unless the limits of every axis are finite and positive.
  LoopState(const LoopConfig& config, const Wheel& last_wheel)
      : config(config),
        wheel(last_wheel),
        limit_check(config.machine.limits, config.machine.period, LimitCheck::kUnplannedRoundings),
        axis_move(config.machine) {
    status.wheel = last_wheel;
  }

  void apply(MachineEvent event) noexcept {
    if (const auto next = after(sample.state, event)) sample.state = *next;
  }

  const LoopConfig config;
  CycleSample sample;  ///< passed on at the end of the cycle; its state and command are always the present ones
  LoopStatus status;   ///< published at the end of the cycle
  WheelWatch wheel;
  LimitCheck limit_check;
  AxisMove axis_move;  ///< motion of the lift or jog
};

}  // namespace grinder
