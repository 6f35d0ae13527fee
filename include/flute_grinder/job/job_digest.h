#pragma once

#include <string>

namespace grinder {

struct GrindJob;

/// Identifies a job: SHA-256, in hexadecimal, of its numbers and choices that are not 0. A number that a later version
/// adds thus leaves the digests of jobs without it unchanged. Computed values are not included.
/// @throw std::runtime_error if the hash cannot be computed.
std::string jobDigest(const GrindJob& job);

/// Identifies the wheel of a job in the same way: its numbers except its wear, which the job compensates, and its
/// width.
std::string wheelDigest(const GrindJob& job);

/// Identifies a tool by the position of its teeth: the dimensions of its cutter and teeth, and the set-up of its
/// flutes. The same for all operations, tolerances, feeds, passes and reliefs.
std::string toolDigest(const GrindJob& job);

}  // namespace grinder
