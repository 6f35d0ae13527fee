#pragma once

namespace grinder {

/// From now on SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is gone) are counted instead of ending the program.
/// SIGHUP stays ignored if it was, as under nohup.
void catchInterrupts();

/// The number of signals caught by catchInterrupts().
int interrupts();

/// From now on SIGTSTP (Ctrl-Z) is counted instead of suspending the program.
void catchHolds();

/// The number of signals caught by catchHolds().
int holds();

}  // namespace grinder
