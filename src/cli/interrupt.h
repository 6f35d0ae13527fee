#pragma once

namespace grinder {

/// From now on SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is gone) are counted instead of ending the program.
/// SIGHUP stays ignored if it was, as under nohup.
void catchInterrupts();

/// How many there have been.
int interrupts();

/// From now on SIGTSTP (Ctrl-Z) is counted instead of suspending the program.
void catchHolds();

/// How many there have been.
int holds();

}  // namespace grinder
