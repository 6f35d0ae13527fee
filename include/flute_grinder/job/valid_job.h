#pragma once

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

/// The depth of a pass over X.
struct DepthLaw {
  double at_end = 0;  ///< at the small end, radial [m]
  double taper = 0;   ///< added to the cone's dY/dX
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
  /// Implicit: a job may stand where a valid one is taken. @throw InvalidJob
  ValidJob(GrindJob job);

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
  /// Every pass has the same part of its depth everywhere, so that no infeed is larger than the job's.
  /// @param depth of the pass where the flute is deepest, as in depths() [m].
  DepthLaw depthLaw(double depth) const noexcept;

  /// What the strokes of a tooth add to the published law of Z.
  /// @throw std::invalid_argument if the job asks for kConstantRake, and withZLaw() has not been called.
  const ZCorrection& zCorrectionOf(int tooth) const;
  /// The job with these. @param corrections one for each tooth. @throw std::invalid_argument for another number.
  ValidJob withZCorrections(std::vector<ZCorrection> corrections) const;

 private:
  struct Content {
    GrindJob job;
    std::vector<CutterGeometry> cutters;  ///< of the teeth
    std::vector<double> depths;
    std::vector<JobPass> passes;
    std::vector<ZCorrection> z_corrections;  ///< of the teeth; empty if they are yet to be computed
  };

  std::shared_ptr<const Content> content_;
};

}  // namespace grinder
