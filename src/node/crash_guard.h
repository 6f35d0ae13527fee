#pragma once

#include "flute_grinder/control/control_loop.h"

namespace grinder {

/// If any thread but the control loop's crashes (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT), it waits until the loop has
/// stopped the axes on the path, lifted the wheel and switched the power off, and 0.2 s more for the telemetry to
/// publish the last setpoints; only then does the process end. A crash of the loop's own thread or a stack overflow
/// ends the process at once; then the drive's watchdog must stop the axes.
/// @param loop running; must outlive endCrashGuard().
void stopAxesOnCrash(ControlLoop& loop);

/// Ends the guard: from now on a crash ends the process at once. To be called once the loop has stopped.
void endCrashGuard();

}  // namespace grinder
