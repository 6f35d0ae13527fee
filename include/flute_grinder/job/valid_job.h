#pragma once

#include "flute_grinder/curve/face_stroke.h"
#include "flute_grinder/curve/relief_path.h"
#include "flute_grinder/job/grind_job.h"

#include <memory>
#include <stdexcept>
#include <string>
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

/// The wheel of a relief, and its set-up on the machine.
ReliefWheel reliefWheelOf(const GrindProcess& process);

/// The start of a job's relief behind the edge of a tooth; a secondary relief starts at the end of the primary's land.
/// @param tooth the tooth's cutter.
/// @throw std::invalid_argument if the primary relief is narrower than the land.
ReliefStart reliefStartOf(const GrindJob& job, const ConicalCutter& tooth);

/// Y of a pass over X: the cone's Y plus the taper, less the depth.
struct DepthLaw {
  double at_end = 0;  ///< depth below the cone's Y at X = 0 [m]
  double taper = 0;   ///< slope added to the cone's dY/dX
};

/// The strokes of a tooth: the travel of X, and the laws by which A and Z follow it.
struct StrokeLaw {
  Cone cutter;              ///< cutter whose helix A follows, and whose rake Z follows
  double from = 0, to = 0;  ///< X of the stroke's ends, in the direction of travel [m]
  double x_shift = 0;       ///< shift of A's curve along X [m]
  double a = 0;             ///< angle added to A [rad]
};

/// The helix through the ends of a tooth's ground edge.
struct EdgeHelix {
  double spiral_angle = 0;  ///< [rad]
  double at_end = 0;        ///< angle of the edge at the small end, less the tooth's angle [rad]
  /// The angle by which the edge is ahead of the helix that begins at the tooth's angle: the middle of its extremes
  /// along the flute [rad].
  double ahead = 0;
};

/// How a job grinds the end of a tooth: the outward normal of the plane, and a place on it.
struct EndPlane {
  OnTooth normal, through;
};
EndPlane endPlaneOf(const GrindJob& job);

/// The only swivel that lays the plane of an operation on the end on a face of the wheel [rad].
double swivelOfPlane(const GrindJob& job);

/// The tooth of an operation on the end.
EndTooth endToothOf(const GrindJob& job, int tooth);

/// The bottom of a tooth's gash, as for gashStroke().
struct GashBottom {
  double angle = 0;  ///< [rad]
  double past = 0;   ///< [m]
};
GashBottom gashBottomOf(const GrindJob& job, int tooth);

/// A pass of a job.
struct JobPass {
  ToothPass place;
  double depth = 0;  ///< depth of the pass where the flute is deepest [m]
  /// What the pass compensates, as the job predicts it at the start of the pass: the wear of the wheel's radius, or
  /// that of its face since the job began; see isByFace() [m].
  double wear = 0;
};

/// A job that validate() accepts, with everything derived from it, computed once. Copies share it.
class ValidJob {
 public:
  /// Explicit, since a new object from the content of another has neither its laws nor its edges.
  /// @throw InvalidJob if validate() refuses the job.
  explicit ValidJob(GrindJob job);

  const GrindJob& operator*() const noexcept { return content_->job; }
  const GrindJob* operator->() const noexcept { return &content_->job; }

  /// See jobDigest().
  const std::string& digest() const noexcept { return content_->digest; }

  int teeth() const noexcept { return static_cast<int>(content_->cutters.size()); }
  /// The cutter with the spiral angle of one of its teeth.
  const CutterGeometry& cutterOf(int tooth) const { return content_->cutters.at(static_cast<std::size_t>(tooth)); }

  /// The depth of every pass of a tooth in order, where the flute is deepest: infeed steps, the finishing pass,
  /// spark-out. [m]
  /// @throw std::invalid_argument if they follow from what passes remove, and withLaws() has not been called.
  const std::vector<double>& depths() const;
  /// The passes of all teeth, in grinding order.
  /// @throw like depths().
  const std::vector<JobPass>& passes() const;
  bool hasPasses() const noexcept { return !content_->depths.empty(); }  ///< whether depths() and passes() are known
  /// The job with roughing passes.
  /// @param depths their depths, ascending; may be empty [m].
  /// @throw InvalidJob if the job has too many passes then, or the wheel wears away.
  ValidJob withRoughing(std::vector<double> depths) const;
  double deepest() const noexcept { return content_->deepest; }  ///< maximum of depths() [m]
  /// JobPass::wear in each tooth's deepest pass: the first at full depth, when the wheel is largest [m].
  /// @throw like depths(), if the wheel wears from pass to pass.
  std::vector<double> wearOfTeeth() const;

  /// The strokes of a tooth.
  /// @throw std::invalid_argument if the job is a relief, and withEdges() has not been called.
  const StrokeLaw& strokeLaw(int tooth) const;
  /// The law of Y of a pass. Every pass of a flute has the same fraction of the full depth everywhere, so no infeed
  /// exceeds the job's. A relief's passes are each at a constant distance above the last one.
  /// @param depth depth of the pass, as in depths() [m].
  /// @param wear wear of the wheel's radius, compensated in Y [m].
  DepthLaw depthLaw(int tooth, double depth, double wear) const noexcept;
  /// The depth of a pass at the small end [m].
  /// @param depth depth of the pass, as in depths() [m].
  double depthAtEnd(double depth) const noexcept;

  /// The correction that the strokes of a tooth add to the published law of Z.
  /// @throw std::invalid_argument if the job asks for kConstantRake, and withLaws() has not been called.
  const ZCorrection& zCorrectionOf(int tooth) const;
  /// The job with corrections of Z.
  /// @param corrections one for each tooth.
  /// @throw std::invalid_argument for another number.
  ValidJob withZCorrections(std::vector<ZCorrection> corrections) const;

  /// Whether the strokes are straight, at constant A, and so have a faceStroke() and no laws.
  bool isStraight() const noexcept { return grinder::isStraight(content_->job.process().kind); }
  /// The stroke of a pass of an operation on the end, with A of the tooth's edge.
  /// @param depth,wear JobPass::depth and JobPass::wear of the pass [m].
  /// @throw std::invalid_argument if withEdges() has not been called.
  FaceStroke faceStroke(int tooth, double depth, double wear) const;
  /// The wheel in that stroke. @param wear JobPass::wear of the pass [m].
  FaceWheel faceWheel(double wear) const noexcept;

  /// The path of a relief; null for flutes.
  const ReliefPath* relief(int tooth) const noexcept;
  /// The job of a relief or of an operation on the end together with the flutes under it, so that it follows the
  /// ground edges.
  /// @param flutes the job of the flutes, with their law of Z.
  /// @param edges the edges of all teeth.
  /// @throw InvalidJob if no relief can be ground behind these edges.
  ValidJob withEdges(const ValidJob& flutes, std::vector<EdgeHelix> edges) const;
  /// Another operation after the flutes, with the same flutes and edges as this one has from withEdges().
  /// @param index from 1. @throw InvalidJob if it cannot be ground.
  ValidJob ofOperation(int index) const;
  /// The flutes and the edges under another operation, after withEdges().
  const ValidJob& flutes() const { return *content_->flutes; }
  const std::vector<EdgeHelix>& edges() const { return content_->edges; }

 private:
  struct Content {
    GrindJob job;
    std::string digest;
    std::vector<CutterGeometry> cutters;  ///< cutters of the teeth
    std::vector<double> depths;
    std::vector<JobPass> passes;
    std::vector<ZCorrection> z_corrections;  ///< corrections of the teeth; empty until they are computed
    double deepest = 0;
    std::vector<ReliefPath> reliefs;         ///< reliefs of the teeth; empty for flutes
    std::vector<StrokeLaw> laws;             ///< laws of the teeth; empty until a relief's edges are computed
    std::shared_ptr<const ValidJob> flutes;  ///< job of the flutes under another operation
    std::vector<EdgeHelix> edges;            ///< edges of the teeth, for another operation
  };

  /// Computes the reliefs behind the edges, and their depths.
  /// @param edges cutters with the spiral angles of the edges.
  static void takeReliefs(Content& content, const std::vector<CutterGeometry>& edges);
  /// Divides the depth into passes.
  static void takePasses(Content& content);

  std::shared_ptr<const Content> content_;
};

}  // namespace grinder
