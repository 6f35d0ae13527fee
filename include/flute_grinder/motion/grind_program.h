#pragma once

#include "flute_grinder/curve/formed_edge.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/axis_limits.h"
#include "flute_grinder/motion/feed_schedule.h"
#include "flute_grinder/motion/setpoint.h"

#include <vector>

namespace grinder {

/// The position, work offset and pass with which a run of a job begins.
struct RunStart {
  /// @param at machine position of the axes [m], A [rad].
  RunStart(const Axes& at = Axes::Zero(), const ToothPass& first = {}, const Axes& offset = Axes::Zero())
      : at(at), first(first), offset(offset) {}

  Axes at;          ///< machine position of the axes [m], A [rad]
  ToothPass first;  ///< first pass to grind
  Axes offset;      ///< machine position - work position, see WorkOffsets [m], A [rad]

  bool operator==(const RunStart& other) const {
    return (at == other.at).all() && first == other.first && (offset == other.offset).all();
  }
};

/// One move of a job, from the end of the previous move.
struct Move {
  MoveKind kind = MoveKind::kLift;
  std::uint16_t tooth = 0;
  std::uint16_t pass = 0;
  Axes to = Axes::Zero();  ///< end position [m], A [rad]
  double wear = 0;         ///< wear of the wheel's radius, compensated in Y of infeed and stroke along a flute [m]
  double taper = 0;        ///< slope that the stroke adds to the cone's dY/dX
};

/// The path of a tooth's strokes before infeed and indexing, and its feed.
struct Helix {
  FormedEdge edge;
  LogCurve curve;
  ZCorrection z_correction;
  FeedSchedule schedule;

  /// Height Z on the path: the cutter's, with the job's correction. Real-time safe. [m]
  double z(double x) const noexcept {
    return z_correction.pieces == 0 ? edge.cutter.z(x) : edge.cutter.z(x) + z_correction.at(x).z;
  }
};

/// The ordered moves of all teeth and passes of a job. If the wheel is lower than the park position, it first rises to
/// that height. Then, for each pass, A is indexed, and the wheel moves above the start, descends to the clearance,
/// plunges at feed, makes its stroke with overtravel, and retracts radially. From a straight stroke along X the wheel
/// backs off first. At the end the wheel returns to the park position. The plunge compensates for wheel wear, so the
/// compensation never changes within a pass. All positions are in work coordinates.
class GrindProgram {
 public:
  /// @throw std::invalid_argument if `run.first` is not a pass of the job, if `machine` or `run` are out of range, if
  ///        the park position is in the work, if the machine cannot swivel to the job's set-up, if the feed would have
  ///        to be reduced below kMinFeed, or like ValidJob::zCorrectionOf() and passes().
  GrindProgram(const ValidJob& job, const Machine& machine, const RunStart& run);

  const ValidJob& job() const noexcept { return job_; }
  const Machine& machine() const noexcept { return machine_; }
  const RunStart& run() const noexcept { return run_; }
  /// Whether the strokes are straight, at constant A; there are then no helices and no schedules.
  bool isStraight() const noexcept { return helices_.empty(); }
  /// The cutter with the spiral angle of a tooth; all teeth have the same cone. Not of a program of straight strokes.
  const ConicalCutter& cutter(int tooth = 0) const noexcept { return helix(tooth).edge.cutter; }
  double swivel() const noexcept;                                ///< swivel of the job's set-up [rad]
  Axes start() const noexcept { return run_.at - run_.offset; }  ///< start position in work coordinates [m], A [rad]
  const std::vector<Move>& moves() const noexcept { return moves_; }

  /// The path of a tooth's strokes; teeth with the same spiral angle share one.
  const Helix& helix(int tooth) const noexcept { return helices_[helix_of_tooth_[static_cast<std::size_t>(tooth)]]; }
  /// The distinct paths.
  const std::vector<Helix>& helices() const noexcept { return helices_; }
  /// The feed schedule of a tooth's strokes, the same for all passes.
  const FeedSchedule& schedule(int tooth = 0) const noexcept { return helix(tooth).schedule; }
  double strokeFrom() const noexcept { return stroke_.from; }  ///< X at the start of the strokes [m]
  double strokeTo() const noexcept { return stroke_.to; }      ///< X at the end of the strokes [m]

  /// The magnitudes of the largest numbers from which positions of strokes are computed; the positions may be smaller.
  /// A is a difference of angles (to X = 0, and of the tooth), and Y, Z and A are computed from X. [m], A [rad]
  const Axes& terms() const noexcept { return terms_; }

  /// Y at which the wheel is clear of the workpiece over the whole stroke [m].
  double clearanceHeight() const noexcept { return clearance_y_; }
  /// X to which the wheel backs off before it is lifted to that height: the rim of a cup may be round the work.
  /// Infinite where it is lifted straight up [m].
  double clearX() const noexcept { return clear_x_; }

 private:
  void append(MoveKind kind, const ToothPass& pass, const Axes& to, double wear = 0, double taper = 0);
  void appendPass(const JobPass& pass, Axes& at);
  void appendStraightPass(const JobPass& pass, Axes& at);

  ValidJob job_;
  Machine machine_;
  RunStart run_;
  FeedSchedule::Stroke stroke_;
  std::vector<Helix> helices_;
  std::vector<std::size_t> helix_of_tooth_;
  Axes terms_;
  double clearance_y_, clear_x_;
  std::vector<Move> moves_;
};

}  // namespace grinder
