#pragma once

#include "control/fixtures.h"
#include "flute_grinder/machine/loop_fault.h"

#include <functional>
#include <string>
#include <vector>

// What a job needs to grind, and how a drive loses it.
namespace grinder::test_support {

/// A part of the machine that grinding needs and that can be lost.
struct Part {
  const char* name;
  Interlock interlock;
  std::function<void(FakeDrive&)> lose;
  const char* words;
};

inline const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"Reference", Interlock::kNotHomed, [](FakeDrive& d) { d.status.homed = false; }, "the axes are not homed"},
      {"Spindle", Interlock::kSpindle, [](FakeDrive& d) { d.status.spindle_at_speed = false; },
       "the spindle is not at speed"},
      {"Coolant", Interlock::kCoolant, [](FakeDrive& d) { d.status.coolant_on = false; }, "no coolant flows"},
      {"Probe", Interlock::kProbe, [](FakeDrive& d) { d.status.probe_free = false; },
       "the measuring probe is in the way"},
      {"Swivel", Interlock::kSwivel, [](FakeDrive& d) { d.status.swivel = kPaperSwivel + 0.001; },
       "the swivel is not at the job's angle"}};
  return all;
}

/// Restores every part; spindle and coolant follow their commands by themselves.
inline void restoreParts(FakeDrive& drive) {
  drive.status.homed = drive.status.probe_free = true;
  drive.status.swivel = kPaperSwivel;
}

}  // namespace grinder::test_support
