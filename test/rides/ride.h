#pragma once

#include <cstdint>
#include <string>

namespace grinder::test_support {

/// What a ride has come to.
struct RideResult {
  std::string fault;  ///< what is wrong with it; empty if nothing
  std::uint64_t setpoints = 0;
  std::uint64_t cycles = 0;
  int events = 0;  ///< requests and failures on the way
  int runs = 0;    ///< starts of the job
};

/// Rides a random job on a random machine through the control loop, in simulated time, from its start to its end: with
/// holds, overrides, retracts, jogs, cancels, stops, faults and restarts at random moments. Every cycle is judged by
/// the second opinion. @param number the same ride for the same number.
RideResult ride(std::uint64_t number);

}  // namespace grinder::test_support
