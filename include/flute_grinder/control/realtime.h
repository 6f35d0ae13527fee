#pragma once

/// @file
/// What makes a thread fit for the control loop. All to be called once, before the first cycle.
namespace flute_grinder {

/// Keeps the process' memory from being swapped out.
/// @return whether the system grants it without limit: with one, memory could run out later, in the midst of a job.
bool lockMemory();

/// Makes the calling thread one of the control loop: real-time scheduling where the system grants it, a stack that is
/// there, and no signals.
/// @return whether the scheduling was granted.
bool becomeRealtime();

}  // namespace flute_grinder
