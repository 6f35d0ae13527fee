#include "flute_grinder/drive/machine_state.h"

namespace flute_grinder {

namespace {

struct Transition {
  MachineState from;
  MachineEvent event;
  MachineState to;
};

using S = MachineState;
using E = MachineEvent;

constexpr Transition kTransitions[]{
    {S::kDisabled, E::kEnable, S::kReady},    {S::kDisabled, E::kDisable, S::kDisabled},
    {S::kDisabled, E::kReset, S::kDisabled},  // of a fault that the drive has kept, or has got since
    {S::kReady, E::kEnable, S::kReady},       {S::kReady, E::kDisable, S::kDisabled},
    {S::kReady, E::kStart, S::kRunning},      {S::kRunning, E::kCancel, S::kCanceling},
    {S::kRunning, E::kFinished, S::kReady},   {S::kCanceling, E::kCancel, S::kCanceling},
    {S::kCanceling, E::kFinished, S::kReady}, {S::kFault, E::kReset, S::kDisabled},
    {S::kReady, E::kFault, S::kFault},        {S::kRunning, E::kFault, S::kFault},
    {S::kCanceling, E::kFault, S::kFault},
};

bool isRequest(MachineEvent event) noexcept { return event < MachineEvent::kFinished; }

}  // namespace

const char* toString(MachineState state) noexcept {
  switch (state) {
    case S::kDisabled: return "disabled";
    case S::kReady: return "ready";
    case S::kRunning: return "running";
    case S::kCanceling: return "canceling";
    case S::kFault: return "fault";
  }
  return "unknown";
}

const char* toString(MachineEvent event) noexcept {
  switch (event) {
    case E::kEnable: return "enable";
    case E::kDisable: return "disable";
    case E::kStart: return "start";
    case E::kCancel: return "cancel";
    case E::kReset: return "reset";
    case E::kFinished: return "finished";
    case E::kFault: return "fault";
  }
  return "unknown";
}

std::optional<MachineState> after(MachineState state, MachineEvent event) noexcept {
  for (const Transition& t : kTransitions) {
    if (t.from == state && t.event == event) return t.to;
  }
  return std::nullopt;
}

std::string allowedIn(MachineState state) {
  std::string text;
  for (const Transition& t : kTransitions) {
    if (t.from == state && isRequest(t.event)) text += (text.empty() ? "" : ", ") + std::string(toString(t.event));
  }
  return text;
}

}  // namespace flute_grinder
