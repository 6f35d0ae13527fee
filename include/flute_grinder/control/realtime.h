#pragma once

/// @file
/// Prepares the process and the thread for the control loop. Call each function once, before the first cycle.
namespace flute_grinder {

/// Keeps the process's memory from being swapped out.
/// @return whether the system grants this without a limit; with a limit, memory could run out in the middle of a job.
bool lockMemory();

/// Prepares the calling thread: real-time scheduling if the system grants it, a resident stack, and no signals.
/// @return whether real-time scheduling was granted.
bool becomeRealtime();

}  // namespace flute_grinder
