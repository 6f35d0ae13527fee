#pragma once

#include "flute_grinder/control/control_loop.h"

namespace flute_grinder {

/// When any thread but the control loop's crashes - SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT - the crashed thread waits
/// until the loop has stopped the axes on the path, lifted the wheel and switched the power off, and only then lets the
/// process end as it would have. A crash of the loop's own thread, and a stack that has run out, end the process at
/// once; then it is the drive's watchdog that must stop the axes.
/// @param loop started; must live as long as the process.
void stopAxesOnCrash(ControlLoop& loop);

/// From now on a crash ends the process at once; to be called when the loop has ended.
void endCrashGuard();

}  // namespace flute_grinder
