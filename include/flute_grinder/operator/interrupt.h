#pragma once

namespace flute_grinder {

/// From now on SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is gone) are counted in place of ending the program.
/// SIGHUP stays ignored where it was, as nohup has it.
void catchInterrupts();

/// How many there have been.
int interrupts();

}  // namespace flute_grinder
