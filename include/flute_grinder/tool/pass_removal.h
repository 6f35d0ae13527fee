#pragma once

#include <cstddef>
#include <vector>

namespace grinder {

class ValidJob;

/// What a pass of an operation removes.
struct PassRemoval {
  double depth = 0;   ///< as in ValidJob::depths() [m]
  double area = 0;    ///< from a section of a tooth: the largest of those amid the flute and at both ends [m^2]
  double rate = 0;    ///< that area, times the speed along the axis at the job's feed [m^3/s]
  double volume = 0;  ///< from all teeth, over the length of the flute [m^3]
};

constexpr std::size_t kMaxMeasuredPasses = 100;  ///< passes of a tooth above which none is measured

/// Measures what each pass of a tooth removes. Takes some tenths of a second.
/// @param job job from withLaws().
/// @return one for each of ValidJob::depths(); empty for an operation on the end, and for too many passes.
/// @throw like wheelOf().
std::vector<PassRemoval> removalOfPasses(const ValidJob& job);

}  // namespace grinder
