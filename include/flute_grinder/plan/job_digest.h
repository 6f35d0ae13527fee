#pragma once

#include <string>

namespace grinder {

struct GrindJob;

/// Identifies a job: SHA-256, in hexadecimal, of its figures and choices that are not 0, so that one that a later
/// version adds leaves the digest of a job without it as it was. What is computed for a job is not included.
/// @throw std::runtime_error if the hash cannot be computed.
std::string jobDigest(const GrindJob& job);

/// Identifies the wheel of a job in the same way: its figures but its wear, which the job follows, and its width.
std::string wheelDigest(const GrindJob& job);

/// Identifies a tool by where its teeth are: the figures of its cutter, of its teeth and of the set-up of its flutes.
/// The same for every operation of it, and whatever its tolerances, feeds, passes and reliefs.
std::string toolDigest(const GrindJob& job);

}  // namespace grinder
