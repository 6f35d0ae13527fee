#pragma once

/// @file
/// Prepares the process and the thread for the control loop. Call each function once, before the first cycle;
/// boundAddressSpace() after everything else has been set up.
namespace grinder {

/// Sets the default stack of new threads to 512 KB. lockMemory() makes the stacks of all threads resident as a whole,
/// and the system's default is 8 MB.
/// @throw std::system_error
void boundThreadStacks();

/// Limits the process to 2 GB of addresses beyond its present use. A few bytes from a peer can ask for more; that must
/// end in std::bad_alloc, and must not make the system kill a process.
/// @throw std::system_error
void boundAddressSpace();

/// Makes all of the process's memory resident, so that the control loop meets no page fault: the code of all libraries,
/// stacks, and whatever the loop and the drive have allocated so far. Memory allocated later becomes resident when
/// it is first accessed. No memory is swapped out.
/// @return whether the system grants this without a limit; with a limit, memory could run out in the middle of a job.
bool lockMemory();

/// Prepares the calling thread: real-time scheduling if the system grants it, a resident stack, and no signals.
/// @return whether real-time scheduling was granted.
bool becomeRealtime();

}  // namespace grinder
