#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/geometry/ground_cutter.h"
#include "flute_grinder/job/axes.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/setpoint.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// A stroke of a run; or a part of another move in which the wheel was in the blank where no stroke of the tooth
/// was.
struct RunStroke {
  ToothPass place;
  MoveKind move = MoveKind::kStroke;
  Range range;                            ///< of X [m]
  std::vector<PathDeviation> deviations;  ///< as GrindStroke has them
};

/// The strokes of a run from the positions that the drive read, and the cutter as they ground it: all that they and the
/// other moves, as infeed and retract, removed together. What was not received is not removed. Setpoints that are
/// missing within a stroke are taken to lie between their neighbours.
class RunStrokes {
 public:
  /// How far a stroke may lie beyond another one and still count as covered by it: what it removes in addition is
  /// thinner than twice that [m].
  static constexpr double kSame = 0.5e-6;

  /// @param job from withLaws().
  /// @param before the cutter as the operations ahead of a relief ground it; nothing: as they are planned.
  explicit RunStrokes(const ValidJob& job, std::optional<GroundCutter> before = std::nullopt);

  /// Those of a run that is over. @param strokes of this job, as strokes() had them.
  /// @throw std::invalid_argument for a tooth or a pass that the job does not have, and for a stroke without positions.
  RunStrokes(const ValidJob& job, std::vector<RunStroke> strokes, std::optional<GroundCutter> before = std::nullopt);

  /// Takes the setpoints of a job in order. Those that do not belong to a stroke are needed as well.
  /// @param actual position that was read one cycle before [m], A [rad].
  /// @throw std::invalid_argument for a tooth or a pass that the job does not have, and for a position that is not
  ///        finite.
  void add(const Setpoint& setpoint, const Axes& actual);

  /// To be called after the last setpoint.
  void finish();

  const ValidJob& job() const noexcept { return job_; }
  /// Whether the operations ahead are taken as planned.
  bool isOnPlanned() const noexcept { return job_->operation > 0 && !before_; }
  /// All strokes in the order of the run; one that was broken off by a lift and went on is there twice, up to the
  /// lift and as a whole. Behind them, the parts of other moves.
  const std::vector<RunStroke>& strokes() const noexcept { return strokes_; }

  /// What the wheel removed in one of these, as if the tooth were at angle 0.
  WheelSweep sweep(const RunStroke& stroke) const;

  /// The cutter as ground; a tooth without a stroke removes nothing. Strokes that another one covers are left out: they
  /// cost time and remove nothing more.
  GroundCutter cutter() const;

 private:
  /// The mean of some positions that are near one another.
  struct Sample {
    int count = 0;
    double x = 0;
    PathDeviation off;
  };
  /// What a setpoint belongs to.
  struct Part {
    ToothPass place;
    MoveKind move;
    std::uint64_t cycle;
  };
  /// Positions outside strokes with the wheel in the blank, without a gap in between.
  struct Poses {
    ToothPass place;
    MoveKind move;
    std::vector<Axes> at;
  };
  /// The job's deepest path of a tooth.
  struct Path {
    Path(const ValidJob& job, int tooth, double wear);
    PathDeviation deviation(double x, const Axes& at) const;

    ConicalCutter cutter;
    LogCurve curve;
    GrindStroke stroke;
    double angle;
  };

  /// With the strokes of a relief, on what was ground before.
  GroundCutter relieved(const std::vector<const RunStroke*>& kept) const;
  Path pathOf(const ToothPass& place) const { return {job_, place.tooth, wearOf(place)}; }
  double wearOf(const ToothPass& place) const;
  void requirePlace(const ToothPass& place, const std::string& what) const;
  double depthOf(const RunStroke& s) const { return job_.depths()[static_cast<std::size_t>(s.place.pass)]; }
  void take(const Part& part, const Axes& actual);
  void beginStroke(const ToothPass& place, double x);
  /// Whether a stroke begins at the last position: where its infeed ended, which is the end of its path.
  bool fedInBefore(const Part& part, const Axes& actual) const;
  void sample(const Axes& actual);
  std::vector<PathDeviation> deviations() const;
  void endStroke();
  void addPose(const Part& part, const Axes& actual);
  /// Whether a stroke's wheel at an X takes with it what the wheel of another pass takes while it is off the path by
  /// `off`.
  bool covers(const RunStroke& stroke, const ToothPass& place, double x, const PathDeviation& off) const;
  bool covers(const RunStroke& stroke, const RunStroke& other) const;
  void addOutside(const Poses& poses, std::size_t strokes);
  RunStroke strokeOf(const Poses& poses, std::size_t from, std::size_t to) const;

  const ValidJob job_;
  const std::optional<GroundCutter> before_;
  const double radius_;             ///< the largest of the blank [m]
  std::optional<Part> last_;        ///< of the last setpoint
  std::optional<Part> reading_;     ///< what the last position belongs to
  Axes read_ = Axes::Zero();        ///< that position
  std::optional<Path> path_;        ///< of the stroke that is being read
  std::map<long, Sample> samples_;  ///< of the last stroke, by its place on X
  Range range_;                     ///< of that stroke
  std::vector<Poses> poses_;
  bool in_blank_ = false;  ///< whether the last position is in the last of these
  std::vector<RunStroke> strokes_;
};

}  // namespace grinder
