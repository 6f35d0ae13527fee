#pragma once

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/control/control_loop.h"

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace grinder {

/// The error of a probing cycle without a result.
class ProbingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Moves the axes in a probing cycle, with the measuring probe. Polls the loop's status to await the motion. The motion
/// ends if RequestBox::keepAlive() is not called for jog_timeout, and with any stop, after which all further moves are
/// refused.
class Prober {
 public:
  /// The result of the slow touches at one place.
  struct Touch {
    std::array<double, kAxisCount> axes{};  ///< machine positions; the mean for the axis that searched
    double spread = 0;                      ///< largest - smallest [m], A [rad]
  };

  /// @param loop must outlive this object. @param stops LoopStatus::stops when the cycle was requested.
  /// @param on_touch called before each touch. @param place, touch from 0; touch 0 is the search.
  Prober(ControlLoop& loop, std::uint64_t stops, std::function<void(int place, int touch)> on_touch);

  const LoopConfig& config() const { return loop_.config(); }

  /// Searches, touches as often as the configuration says, and rests off the surface.
  /// @param distance longest way to a contact, signed, not 0 [m], A [rad].
  /// @throw ProbingError
  Touch touch(int axis, double distance);

  /// Turns the work. @param angle signed [rad]. @throw ProbingError
  void turn(double angle);

  /// @throw ProbingError if a stop came since the cycle began.
  void checkStop() const;

 private:
  struct Search {
    int axis;
    double toward;  ///< direction of the search, 1 or -1
    double begin;   ///< position of the axis at the start [m], A [rad]
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

/// A length, or an angle for A, as text in the operator's units.
std::string shownOf(int axis, double si);

}  // namespace grinder
