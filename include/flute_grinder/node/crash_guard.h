#pragma once

#include "flute_grinder/drive/control_loop.h"

namespace flute_grinder {

/// When any thread but the control loop's crashes - SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT - the crashed thread waits
/// until the loop has stopped the axes on the path, lifted the wheel and switched the power off, and only then lets the
/// process end as it would have. A crash of the loop's own thread ends the process at once; then it is the drive's
/// watchdog that stops the axes.
/// @param loop started; must live as long as the process.
void stopAxesOnCrash(ControlLoop& loop);

/// A crash is nothing special any more; for when the loop has ended.
void endCrashGuard();

}  // namespace flute_grinder
