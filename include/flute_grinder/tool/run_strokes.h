#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/setpoint.h"
#include "flute_grinder/tool/end_volumes.h"
#include "flute_grinder/tool/ground_cutter.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// A stroke of a run, or a part of another move in which the wheel was in the blank outside all strokes of the tooth.
struct RunStroke {
  ToothPass place;
  MoveKind move = MoveKind::kStroke;
  Range range;                            ///< range of X; of a straight stroke, of the way from its beginning [m]
  std::vector<PathDeviation> deviations;  ///< deviations, see GrindStroke
};

/// The strokes of a run, from the positions that the drive read, and the cutter that they and the other moves (e.g.
/// infeed, retract) ground. Positions that were not received remove nothing; missing setpoints within a stroke are
/// interpolated.
class RunStrokes {
 public:
  /// Tolerance within which one stroke covers another: the other one removes an additional layer thinner than twice
  /// this [m].
  static constexpr double kSame = 0.5e-6;

  /// @param job job from withLaws().
  /// @param before the cutter as ground by the operations before a relief; nothing: as planned.
  explicit RunStrokes(const ValidJob& job, std::optional<GroundCutter> before = std::nullopt);

  /// The strokes of a finished run.
  /// @param strokes strokes of this job, from strokes().
  /// @throw std::invalid_argument for a tooth or a pass that the job does not have, and for a stroke without positions.
  RunStrokes(const ValidJob& job, std::vector<RunStroke> strokes, std::optional<GroundCutter> before = std::nullopt);

  /// Takes the setpoints of a job in order, including setpoints outside strokes.
  /// @param actual position read one cycle before [m], A [rad].
  /// @throw std::invalid_argument for a tooth or a pass that the job does not have, and for a position that is not
  ///        finite.
  void add(const Setpoint& setpoint, const Axes& actual);

  /// To be called after the last setpoint.
  void finish();

  const ValidJob& job() const noexcept { return job_; }
  /// Whether the preceding operations are taken as planned.
  bool isOnPlanned() const noexcept { return job_->operation > 0 && !before_; }
  /// All strokes in the order of the run, followed by the parts of other moves. A stroke that was interrupted by a lift
  /// is there twice, up to the lift and as a whole.
  const std::vector<RunStroke>& strokes() const noexcept { return strokes_; }

  /// The volume that the wheel removed in a stroke, as if the tooth were at angle 0.
  WheelSweep sweep(const RunStroke& stroke) const;

  /// The deepest strokes of a run on the end, as the mean of their positions has them, by the number of the tooth; none
  /// of other runs.
  EndStrokes straightStrokes() const;

  /// The ground cutter; a tooth without a stroke removes nothing. Strokes that another one covers are left out, since
  /// they cost time and remove nothing more. Strokes on the end leave it as it was before.
  GroundCutter cutter() const;

 private:
  /// The mean of neighbouring positions.
  struct Sample {
    int count = 0;
    double x = 0;
    PathDeviation off;
  };
  /// The move that a setpoint belongs to.
  struct Part {
    ToothPass place;
    MoveKind move;
    std::uint64_t cycle;
  };
  /// Consecutive positions outside strokes with the wheel in the blank.
  struct Poses {
    ToothPass place;
    MoveKind move;
    std::vector<Axes> at;
  };
  /// The job's deepest path for a tooth.
  class Path {
   public:
    Path(const ValidJob& job, int tooth, double wear);
    /// The place on the path of a position: its X, or the way along a straight stroke [m].
    double placeOf(const Axes& at) const;
    PathDeviation deviation(double place, const Axes& at) const;
    /// Whether the stroke begins at the least place.
    bool rises() const { return straight_ || stroke_.from < stroke_.to; }

   private:
    ConicalCutter cutter_;
    LogCurve curve_;
    GrindStroke stroke_;
    double angle_ = 0;
    std::optional<FaceStroke> straight_;
  };

  /// The cutter with the strokes of a relief, on top of the preceding operations.
  GroundCutter relieved(const std::vector<const RunStroke*>& kept) const;
  Path pathOf(const ToothPass& place) const { return {job_, place.tooth, wearOf(place)}; }
  double wearOf(const ToothPass& place) const;
  void requirePlace(const ToothPass& place, const std::string& what) const;
  double depthOf(const RunStroke& s) const { return job_.depths()[static_cast<std::size_t>(s.place.pass)]; }
  void take(const Part& part, const Axes& actual);
  void beginStroke(const ToothPass& place, const Axes& actual);
  /// Whether a stroke begins at the last position: at the end of its infeed, which is the end of its path.
  bool fedInBefore(const Part& part, const Axes& actual) const;
  void sample(const Axes& actual);
  std::vector<PathDeviation> deviations() const;
  void endStroke();
  void addPose(const Part& part, const Axes& actual);
  /// Whether a stroke's wheel at an X removes everything that the wheel of another pass removes there while it is off
  /// the path by `off`.
  bool covers(const RunStroke& stroke, const ToothPass& place, double x, const PathDeviation& off) const;
  bool covers(const RunStroke& stroke, const RunStroke& other) const;
  void addOutside(const Poses& poses, std::size_t strokes);
  RunStroke strokeOf(const Poses& poses, std::size_t from, std::size_t to) const;

  const ValidJob job_;
  const std::optional<GroundCutter> before_;
  const double radius_;             ///< maximum radius of the blank [m]
  std::optional<Part> last_;        ///< move of the last setpoint
  std::optional<Part> reading_;     ///< move of the last position
  Axes read_ = Axes::Zero();        ///< the last position
  std::optional<Path> path_;        ///< path of the stroke that is being read
  std::map<long, Sample> samples_;  ///< samples of the last stroke, by their place on X
  Range range_;                     ///< range of the last stroke
  std::vector<Poses> poses_;
  bool in_blank_ = false;  ///< whether the last position is in the last element of poses_
  std::vector<RunStroke> strokes_;
};

}  // namespace grinder
