#pragma once

#include "flute_grinder/curve/relief_path.h"
#include "flute_grinder/job/grind_job.h"

#include <memory>
#include <stdexcept>
#include <vector>

namespace grinder {

/// Thrown for a job that validate() refuses.
class InvalidJob : public std::invalid_argument {
 public:
  /// @param reasons not empty.
  explicit InvalidJob(std::vector<Reason> reasons);
  const std::vector<Reason>& reasons() const noexcept { return reasons_; }

 private:
  std::vector<Reason> reasons_;
};

/// The wheel of a relief, and how the machine is set for it.
ReliefWheel reliefWheelOf(const GrindProcess& process);

/// Where a job's relief begins behind the edge of a tooth: of a secondary one, at the end of the primary's land.
/// @param tooth its cutter. @throw std::invalid_argument if the primary is not as wide as the land.
ReliefStart reliefStartOf(const GrindJob& job, const ConicalCutter& tooth);

/// Y of a pass over X: that of the cone, the taper's, less the depth.
struct DepthLaw {
  double at_end = 0;  ///< below the cone's at X = 0 [m]
  double taper = 0;   ///< added to the cone's dY/dX
};

/// The strokes of a tooth: where X goes, and by which laws A and Z follow it.
struct StrokeLaw {
  CutterGeometry cutter;    ///< whose helix A, and whose rake Z follows
  double from = 0, to = 0;  ///< X of the ends, in the direction of the strokes [m]
  double x_shift = 0;       ///< of A's curve [m]
  double a = 0;             ///< added to A [rad]
};

/// The helix through the ends of a tooth's edge, as its flute leaves it.
struct EdgeHelix {
  double spiral_angle = 0;  ///< [rad]
  /// By which the edge is ahead of the helix that begins at the tooth's angle: the middle of its extremes along the
  /// flute [rad].
  double ahead = 0;
};

/// A pass of a job.
struct JobPass {
  ToothPass place;
  double depth = 0;  ///< where the flute is deepest [m]
  double wear = 0;   ///< of the wheel when it begins, as foreseen by the job [m]
};

/// A job that validate() accepts, with what follows from it, computed once. Copies share it.
class ValidJob {
 public:
  /// Explicit: one made anew of a valid job's content has neither its laws nor its edges. @throw InvalidJob
  explicit ValidJob(GrindJob job);

  const GrindJob& operator*() const noexcept { return content_->job; }
  const GrindJob* operator->() const noexcept { return &content_->job; }

  int teeth() const noexcept { return static_cast<int>(content_->cutters.size()); }
  /// The cutter with the spiral angle of one of its teeth.
  const CutterGeometry& cutterOf(int tooth) const { return content_->cutters.at(static_cast<std::size_t>(tooth)); }

  /// The depth of every pass of a tooth in order, where the flute is deepest: infeed steps, the finishing pass,
  /// spark-out. [m]
  const std::vector<double>& depths() const noexcept { return content_->depths; }
  /// The passes of all teeth, in grinding order.
  const std::vector<JobPass>& passes() const noexcept { return content_->passes; }
  double deepest() const noexcept { return content_->deepest; }  ///< of depths() [m]

  /// Of a tooth. @throw std::invalid_argument if the job is a relief, and withEdges() has not been called.
  const StrokeLaw& strokeLaw(int tooth) const;
  /// Every pass of a flute has the same part of its depth everywhere, so that no infeed is larger than the job's. A
  /// relief's are as much higher everywhere than the last one.
  /// @param depth of the pass, as in depths() [m]. @param wear of the wheel, which Y compensates [m].
  DepthLaw depthLaw(int tooth, double depth, double wear) const noexcept;
  /// The depth of a pass at the small end [m]. @param depth as in depths() [m].
  double depthAtEnd(double depth) const noexcept;

  /// What the strokes of a tooth add to the published law of Z.
  /// @throw std::invalid_argument if the job asks for kConstantRake, and withLaws() has not been called.
  const ZCorrection& zCorrectionOf(int tooth) const;
  /// The job with these. @param corrections one for each tooth. @throw std::invalid_argument for another number.
  ValidJob withZCorrections(std::vector<ZCorrection> corrections) const;

  /// The path of a relief. @return null for flutes.
  const ReliefPath* relief(int tooth) const noexcept;
  /// A relief's job with what it is ground on: the reliefs follow the edges as they are.
  /// @param flutes the job of the flutes, with their law of Z. @param edges of every tooth. @throw InvalidJob
  ValidJob withEdges(const ValidJob& flutes, std::vector<EdgeHelix> edges) const;
  /// Of a relief after withEdges().
  const ValidJob& flutes() const { return *content_->flutes; }
  const std::vector<EdgeHelix>& edges() const { return content_->edges; }

 private:
  struct Content {
    GrindJob job;
    std::vector<CutterGeometry> cutters;  ///< of the teeth
    std::vector<double> depths;
    std::vector<JobPass> passes;
    std::vector<ZCorrection> z_corrections;  ///< of the teeth; empty if they are yet to be computed
    double deepest = 0;
    std::vector<ReliefPath> reliefs;         ///< of the teeth; empty for flutes
    std::vector<StrokeLaw> laws;             ///< of the teeth; empty if a relief's edges are yet to be computed
    std::shared_ptr<const ValidJob> flutes;  ///< of a relief
    std::vector<EdgeHelix> edges;            ///< of the teeth, for a relief
  };

  /// Computes the reliefs behind edges, and their depths. @param edges the cutters with the spiral angles of these.
  static void takeReliefs(Content& content, const std::vector<CutterGeometry>& edges);

  std::shared_ptr<const Content> content_;
};

}  // namespace grinder
