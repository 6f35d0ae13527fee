#pragma once

/// @file
/// Prepares the process and the thread for the control loop. Each function is called once, before the first cycle.
namespace flute_grinder {

/// Keeps the process' memory from being swapped out.
/// @return whether the system grants it without a limit; under a limit, memory could run out in the middle of a job.
bool lockMemory();

/// Prepares the calling thread: real-time scheduling where the system grants it, a resident stack, and no signals.
/// @return whether the scheduling was granted.
bool becomeRealtime();

}  // namespace flute_grinder
