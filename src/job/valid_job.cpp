#include "flute_grinder/job/valid_job.h"

#include <string>
#include <utility>

namespace grinder {

namespace {

std::vector<JobPass> passesOf(const GrindJob& job, const std::vector<double>& depths) {
  const int teeth = static_cast<int>(job.tooth_angles.size());
  const int passes = static_cast<int>(depths.size());
  const bool tooth_major = job.process.order == GrindOrder::kToothMajor;
  std::vector<JobPass> all;
  all.reserve(static_cast<std::size_t>(teeth) * depths.size());
  for (int i = 0; i < teeth * passes; ++i) {
    const ToothPass place = tooth_major ? ToothPass{i / passes, i % passes} : ToothPass{i % teeth, i / teeth};
    all.push_back({place, depths[static_cast<std::size_t>(place.pass)],
                   job.process.wheel_wear + i * job.process.wheel_wear_per_pass});
  }
  return all;
}

}  // namespace

InvalidJob::InvalidJob(std::vector<Reason> reasons)
    : std::invalid_argument(text(reasons)), reasons_(std::move(reasons)) {}

ValidJob::ValidJob(GrindJob job) {
  std::vector<Reason> reasons = validate(job);
  if (!reasons.empty()) throw InvalidJob(std::move(reasons));
  Content content;
  content.cutters.assign(job.tooth_angles.size(), job.cutter);
  for (std::size_t i = 0; i < job.spiral_angles.size(); ++i) content.cutters[i].spiral_angle = job.spiral_angles[i];
  content.depths = passDepths(job.process);
  content.passes = passesOf(job, content.depths);
  if (job.process.z_law == ZLaw::kPublished) content.z_corrections.resize(job.tooth_angles.size());
  content.job = std::move(job);
  content_ = std::make_shared<const Content>(std::move(content));
}

DepthLaw ValidJob::depthLaw(double depth) const noexcept {
  const GrindProcess& p = content_->job.process;
  const double deepest = p.deepest();
  const double taper = (p.depth - p.depthEnd()) / content_->job.cutter.flute_length;
  return {depth * (p.depth / deepest), depth / deepest * taper};
}

const ZCorrection& ValidJob::zCorrectionOf(int tooth) const {
  if (content_->z_corrections.empty()) {
    throw std::invalid_argument("process.z_law = constant_rake: its corrections of Z are not computed; see withZLaw()");
  }
  return content_->z_corrections.at(static_cast<std::size_t>(tooth));
}

ValidJob ValidJob::withZCorrections(std::vector<ZCorrection> corrections) const {
  if (corrections.size() != content_->cutters.size()) {
    throw std::invalid_argument(std::to_string(corrections.size()) +
                                " corrections of Z; allowed: " + std::to_string(teeth()) + ", one for each tooth");
  }
  ValidJob job = *this;
  Content content = *content_;
  content.z_corrections = std::move(corrections);
  job.content_ = std::make_shared<const Content>(std::move(content));
  return job;
}

}  // namespace grinder
