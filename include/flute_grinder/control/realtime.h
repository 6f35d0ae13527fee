#pragma once

/// @file
/// Prepares the process and the thread for the control loop. Call each function once, before the first cycle;
/// boundAddressSpace() once all else that the process needs is there.
namespace grinder {

/// Gives the threads that are created from now on a stack of 512 KB, unless they ask for another. lockMemory() makes
/// the stacks of all threads resident as a whole; the system's default is 8 MB.
/// @throw std::system_error
void boundThreadStacks();

/// Lets the process take 2 GB of addresses beside those that it has: a few bytes from a peer can announce more, and
/// must end in std::bad_alloc, not in the system's choice of a process to kill.
/// @throw std::system_error
void boundAddressSpace();

/// Makes all of the process's memory resident, so that the control loop meets no page fault: the code of all libraries,
/// stacks, and whatever the loop and the drive have allocated so far. Memory that is taken later becomes resident when
/// it is first accessed. None of it is swapped out.
/// @return whether the system grants this without a limit; with a limit, memory could run out in the middle of a job.
bool lockMemory();

/// Prepares the calling thread: real-time scheduling if the system grants it, a resident stack, and no signals.
/// @return whether real-time scheduling was granted.
bool becomeRealtime();

}  // namespace grinder
