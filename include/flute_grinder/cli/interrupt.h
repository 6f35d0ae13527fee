#pragma once

namespace flute_grinder {

/// From now on SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is gone) are counted in place of ending the program.
/// SIGHUP stays ignored where it was, as nohup has it.
void catchInterrupts();

/// How many there have been.
int interrupts();

/// From now on SIGTSTP (Ctrl-Z) is counted in place of suspending the program.
void catchHolds();

/// How many there have been.
int holds();

}  // namespace flute_grinder
