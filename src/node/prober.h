#pragma once

#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/job/quantity.h"

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace grinder {

/// Why a probing cycle has no result.
class ProbingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Moves the axes in a probing cycle, with the measuring probe. Waits for the motion by the loop's status. The motion
/// ends where RequestBox::keepAlive() is not called for jog_timeout, and with any stop, which refuses all that follows
/// too.
class Prober {
 public:
  /// What the slow touches at one place say.
  struct Touch {
    std::array<double, kAxisCount> axes{};  ///< positions in machine coordinates; of the axis that searched, the mean
    double spread = 0;                      ///< largest - smallest [m], A [rad]
  };

  /// @param loop must outlive this object. @param stops LoopStatus::stops when the cycle was asked for.
  /// @param on_touch called before each touch. @param place, touch from 0; touch 0 is the search.
  Prober(ControlLoop& loop, std::uint64_t stops, std::function<void(int place, int touch)> on_touch);

  const LoopConfig& config() const { return loop_.config(); }

  /// Searches, touches as often as the configuration says, and rests off the surface.
  /// @param distance the farthest, signed, and not 0 [m], A [rad].
  /// @throw ProbingError
  Touch touch(int axis, double distance);

  /// Turns the work. @param angle signed [rad]. @throw ProbingError
  void turn(double angle);

  /// @throw ProbingError if a stop came since the beginning.
  void checkStop() const;

 private:
  struct Search {
    int axis;
    double toward;  ///< 1 or -1
    double begin;   ///< where the axis was [m], A [rad]
  };

  LoopStatus touchOnce(const Search& search, double distance, double velocity);
  void goBack(const Search& search);
  void backOff(const Search& search, double from);
  LoopStatus step(int axis, double distance, double velocity, bool to_touch);
  LoopStatus awaitEnd(std::uint64_t jog);

  ControlLoop& loop_;
  const std::uint64_t stops_;
  const std::function<void(int, int)> on_touch_;
  int places_ = 0;
};

/// A length, or of A an angle, as the operator reads it.
std::string shownOf(int axis, double si);

}  // namespace grinder
