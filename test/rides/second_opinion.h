#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

// What every setpoint of a job must keep to, computed anew from the laws of its strokes: curve, depth, limits, order.
// Knows nothing of the product's code.
namespace second_opinion {

using Real = long double;
using Point = std::array<double, 4>;  ///< X, Y, Z [m], A [rad]

/// The path of a tooth's strokes.
struct Tooth {
  Real b = 0, k = 0, x_shift = 0, a = 0;  ///< A = a + k/b ln(1 + b (X - shift))
  Real growth = 0;                        ///< of the surface, dY/dX
  Real z_per_y = 0;
  /// B-spline of degree 5 added to Z, with knots every `piece` from `from`; empty for none.
  Real from = 0, piece = 1;
  std::vector<double> coefficients;
};

/// A pass in the order of grinding: Y = X growth - at_end + X taper; or a straight stroke.
struct Pass {
  int tooth = 0, pass = 0;
  Real at_end = 0, taper = 0;
  Point from{}, to{};        ///< of a straight stroke
  Real stock = 0, wear = 0;  ///< that it leaves, and of the wheel's radius [m]
  Real face_wear = 0;        ///< of the face that grinds [m]
};

struct Asked {
  bool straight = false;  ///< the strokes are, at constant A
  std::vector<Tooth> teeth;
  std::vector<Pass> passes;
  Real from = 0, to = 0;  ///< X of a stroke's ends
  /// The wheel of straight strokes goes round the work: it may rise out of it only where X is
  /// `clear_x` at most.
  bool round_work = false;
  Real clear_x = 0;
  Real clearance = 0;               ///< above the surface, at which only strokes go across
  Real offset_x = 0, offset_y = 0;  ///< of the machine's axes from the work's [m]
  Real deviation = 0;               ///< of A at the surface, across the helix [m]
  Real radius = 0;                  ///< of the surface at X = shift
  Real feed = 0;                    ///< the fastest along the edge [m/s]
  Real period = 0;                  ///< [s]
  Point low{}, high{};              ///< of the machine's axes
  std::array<double, 4> velocity{}, acceleration{}, jerk{};
};

/// What a cycle commanded.
struct Row {
  Point at{};           ///< of the machine
  Point work{};         ///< the same in work coordinates, of a job's setpoint
  bool moves = false;   ///< it has a setpoint
  bool of_job = false;  ///< the setpoint
  bool late = false;    ///< the axes stood still before it, since the computer did
  bool free = false;    ///< without power, or homing: the command follows the positions
  double y = 0;         ///< where the axis really is [m]
  double y_off = 0;     ///< by which the drive reads it too high, and thus takes a command for [m]
  bool rises = false;   ///< the wheel is to be lifted: nothing else moves
  std::uint64_t cycle = 0;
  bool in_stroke = false;
  bool ends_stroke = false;  ///< in the loop's opinion, which may differ by rounding
  bool lifts = false;        ///< a move out of the work
  int tooth = 0, pass = 0;
};

struct Violation : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Watches a job from its start to its end, through whatever comes between.
class Watch {
 public:
  explicit Watch(Asked asked);

  /// @throw Violation
  void see(const Row& row);
  /// How many passes have been ground to their end.
  std::size_t ground() const { return progress_.ground; }

  struct Progress {
    std::size_t ground = 0;
    Real reached = 0;      ///< X up to which the next pass has been ground without a gap
    bool in_work = false;  ///< a job has left the wheel there
    bool entered = false;  ///< a stroke has begun since the wheel was above the work
    bool again = false;    ///< the last stroke was of a pass that is ground, or is but for rounding
  };
  const Progress& progress() const { return progress_; }
  /// What was commanded since then has not come to pass.
  void goOnFrom(const Progress& progress) { progress_ = progress; }

  Real curve(const Tooth& tooth, Real x) const;
  /// Length of the edge by that along the surface.
  Real edge(const Tooth& tooth) const;
  /// How far a place of A is off the curve: at the surface, across the helix [m].
  Real deviation(const Tooth& tooth, Real x, Real a) const;
  Real z(const Tooth& tooth, Real x) const;

 private:
  void checkMotion(const Row& row);
  void checkPlace(const Row& row);
  void checkWayOut(const Row& row);
  bool risesFrom(const Point& from, const Point& to) const;
  bool goesOut(const Point& from, const Point& to, Real offset_x) const;
  void checkStraightPlace(const Row& row);
  bool beginsPass(const Row& row) const;
  void checkStroke(const Row& row);
  void checkStraightStroke(const Row& row, const Pass& pass, bool next);
  void checkFeed(const Row& row, const Tooth& tooth);
  Real lowest(Real x) const;
  Real clearHeight() const;
  Real noiseOf(int axis) const;

  Asked asked_;
  Progress progress_;
  Real turn_ = 0;                     ///< the largest of A's terms [rad]
  std::array<double, 4> farthest_{};  ///< of each axis from 0
  Row last_;
  bool has_last_ = false;
  std::array<Point, 3> ends_{};  ///< of the last pairs, newest first
  std::uint64_t cycle_ = 0;      ///< of the last setpoint
  Real pair_from_ = 0;           ///< X at the last even setpoint of a stroke
  int broken_ = 0;               ///< pairs over which acceleration and jerk mean nothing, since the axes stood still
};

/// Watches the button of a continuous jog, whose message is repeated while it is pressed. Once the messages have failed
/// to come in time, or the jog was stopped, nothing moves by it before a message has said that it is released.
class Button {
 public:
  /// @param timeout longest time between the messages [s].
  explicit Button(Real timeout) : timeout_(timeout) {}

  /// @param period as it counts [s].
  void wait(Real period);
  /// The process stands still for some cycles, in which a message may have come: once, until the next one, the time
  /// counts from here.
  void stall();
  /// A message has come for an axis. Those for another one than it was pressed for do not count.
  void press(int axis);
  void release() { pressed_ = barred_ = false; }
  void stop() { barred_ = barred_ || pressed_; }
  bool isBarred() const { return barred_; }

 private:
  Real timeout_;
  Real age_ = 0;  ///< of the last message [s]
  int axis_ = 0;
  bool pressed_ = false, barred_ = false;
  bool stalled_ = false;  ///< since the last message
};

}  // namespace second_opinion
