#include "flute_grinder/job/valid_job.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace grinder {

namespace {

constexpr double kRunIn = 1e-3;  ///< length at either end of a relief's stroke for reaching the feed and stopping [m]

/// The wear that the first pass compensates: of a face, none, since touching off X has taken it up [m].
double wearAtStart(const GrindProcess& p) { return isByFace(p.kind) ? 0 : p.wheel_wear; }

/// The passes of all teeth, in grinding order.
std::vector<JobPass> passesOf(const GrindJob& job, const std::vector<double>& depths) {
  const int teeth = static_cast<int>(job.tooth_angles.size());
  const int passes = static_cast<int>(depths.size());
  const GrindProcess& p = job.process();
  std::vector<JobPass> all;
  all.reserve(static_cast<std::size_t>(teeth) * depths.size());
  // Groups of passes, each tooth by tooth.
  const auto grind = [&](int from, int to) {
    for (int tooth = 0; tooth < teeth; ++tooth) {
      for (int pass = from; pass < to; ++pass) {
        const double wear = wearAtStart(p) + static_cast<double>(all.size()) * p.wheel_wear_per_pass;
        all.push_back({{tooth, pass}, depths[static_cast<std::size_t>(pass)], wear});
      }
    }
  };
  switch (p.order) {
    case GrindOrder::kToothMajor: grind(0, passes); break;
    case GrindOrder::kPassMajor:
      for (int pass = 0; pass < passes; ++pass) grind(pass, pass + 1);
      break;
    case GrindOrder::kFinishTogether: {
      const int finishing = p.spark_out + (p.finish_infeed > 0 ? 1 : 0);
      grind(0, passes - finishing);
      grind(passes - finishing, passes);
      break;
    }
  }
  return all;
}

constexpr const char* kNoDepths = "the depths of its passes are not computed; see withLaws()";

/// The travel of a relief's start in a stroke: X of the cutter [m].
Range startOf(const ReliefPath& path, double length) {
  return {-path.beyondEnd() - kRunIn, length + path.beyondShank() + kRunIn};
}

/// @throw InvalidJob if there are more passes than the wheel lasts.
void requireWheelLasts(const GrindProcess& p, std::size_t passes) {
  const bool by_face = isByFace(p.kind);
  const double left = by_face ? p.wheel_width - p.wheel_corner_radius_lower - p.wheel_corner_radius_upper
                              : p.wheel_diameter / 2 - p.wheel_wear;
  const double most = left / static_cast<double>(passes);
  if (p.wheel_wear_per_pass == 0 || p.wheel_wear_per_pass < most) return;
  const std::string what = by_face ? "the wheel's width between its corners" : "what is left of the wheel's radius";
  throw InvalidJob({{ReasonKind::kNotBelow, 0, "process.wheel_wear_per_pass", what + ", over the passes of all teeth",
                     Unit::kMetre, p.wheel_wear_per_pass, 0, most}});
}

constexpr const char* kNoEdges = "the edges that the operation follows are not computed; see withLaws()";

FaceWheel faceWheelOf(const GrindProcess& p, double wear) noexcept {
  const double radius = p.wheel_diameter / 2;
  const bool by_face = isByFace(p.kind);
  return {radius,         radius - (by_face ? p.wheel_wear : wear),  p.wheel_width, by_face ? wear : 0,
          p.setup_height, p.wheel_rim > 0 ? radius - p.wheel_rim : 0};
}

/// The stroke of the last pass of an operation on the end, for a tooth at angle 0.
/// @param wear of the pass, see JobPass [m].
/// @throw std::invalid_argument as endStroke().
FaceStroke lastFaceStroke(const GrindJob& job, int tooth, double wear) {
  const GrindProcess& p = job.process();
  const FaceWheel wheel = faceWheelOf(p, wear);
  const EndPlane plane = endPlaneOf(job);
  const EndTooth end = endToothOf(job, tooth);
  switch (p.kind) {
    case OperationKind::kGash: {
      const auto& [angle, past] = gashBottomOf(job, tooth);
      return gashStroke(end, plane.normal, angle, past, wheel, p.clearance + p.stock);
    }
    case OperationKind::kChamfer: return chamferStroke(end, plane.normal, plane.through, wheel, kEndGap, p.clearance);
    default: return endStroke(end, plane.normal, plane.through, wheel, kEndGap, p.clearance);
  }
}

/// @throw InvalidJob if no stroke grinds a tooth's flank; none does later, since the wear of the wheel's face does not
/// move the rim.
void requireFaceStroke(const GrindJob& job, int tooth) {
  if (!isEndFlank(job.process().kind)) return;
  try {
    lastFaceStroke(job, tooth, 0);
  } catch (const std::invalid_argument& error) {
    throw InvalidJob({otherReason("flank of tooth " + std::to_string(tooth + 1) + ": " + error.what())});
  }
}

/// Difference of a set-up's swivel from the plane's that its rounding explains, and no figure of a tool shows [rad].
constexpr double kSameSwivel = 0.01 * units::kDegree;

/// A plane of the end has one swivel.
/// @throw InvalidJob if the set-up has another.
void requireSwivelOfPlane(const GrindJob& job) {
  const double swivel = job.process().setup_swivel, asked = swivelOfPlane(job);
  if (std::abs(swivel - asked) <= kSameSwivel) return;
  throw InvalidJob({{ReasonKind::kNotAllowed, 0, "process.setup_swivel", "that of the plane that is ground,",
                     Unit::kRadian, swivel, 0, asked}});
}

/// The stock that an operation on the end finds on a tooth, as FaceStroke counts it: of a gash radial, else normal to
/// the plane.
double endStockOf(const GrindJob& job, int tooth) {
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process();
  const double radius = c.end_diameter / 2;
  if (p.kind == OperationKind::kGash) {
    const auto& [angle, past] = gashBottomOf(job, tooth);
    return radius + past + p.stock * std::tan(angle);
  }
  const EndPlane plane = endPlaneOf(job);
  const double half = units::kPi / 2, far = radius * std::sin(std::min(half, endToothOf(job, tooth).pitch));
  OnTooth highest(-p.stock, radius, 0);
  if (p.kind == OperationKind::kPrimaryEnd) highest = {-p.stock, 0, far};
  // After the primary flank.
  if (p.kind == OperationKind::kSecondaryEnd) highest = {far * std::tan(c.end_clearance) - p.stock, radius, far};
  return std::max(0.0, plane.normal.dot(highest - plane.through));
}

/// The paths of a relief behind all teeth.
/// @throw InvalidJob if a relief cannot be ground.
std::vector<ReliefPath> reliefsOf(const GrindJob& job, const std::vector<CutterGeometry>& cutters) {
  try {
    std::vector<ReliefPath> paths;
    for (const CutterGeometry& geometry : cutters) {
      const ConicalCutter cutter(geometry);
      paths.emplace_back(cutter, reliefStartOf(job, cutter), reliefWheelOf(job.process()));
      const Range start = startOf(paths.back(), geometry.flute_length);
      if (cutter.radius(start.from) > 0 && cutter.radius(start.to) > 0) continue;
      throw std::invalid_argument("the stroke of the relief goes beyond where the cone closes");
    }
    return paths;
  } catch (const std::invalid_argument& error) {
    throw InvalidJob({otherReason(error.what())});
  }
}

/// The laws of the strokes of all teeth; all reliefs get the longest travel of X that any of them needs.
/// @param edges edges of the teeth; empty for flutes.
std::vector<StrokeLaw> lawsOf(const GrindJob& job, const std::vector<CutterGeometry>& cutters,
                              const std::vector<ReliefPath>& reliefs, const std::vector<EdgeHelix>& edges) {
  const GrindProcess& p = job.process();
  const double length = job.cutter.flute_length;
  std::vector<StrokeLaw> laws;
  Range x{-p.overtravel_end, length + p.overtravel_shank};
  for (std::size_t i = 0; i < reliefs.size(); ++i) {
    const Range own = startOf(reliefs[i], length);
    const double from = own.from + reliefs[i].xShift(), to = own.to + reliefs[i].xShift();
    x = i == 0 ? Range{from, to} : Range{std::min(x.from, from), std::max(x.to, to)};
  }
  if (p.direction == StrokeDirection::kToEnd) std::swap(x.from, x.to);
  for (std::size_t i = 0; i < cutters.size(); ++i) {
    laws.push_back({cutters[i], x.from, x.to, p.setup_x_shift, job.tooth_angles[i]});
    if (reliefs.empty()) continue;
    laws[i].cutter = reliefs[i].cutter().cone();
    laws[i].x_shift = reliefs[i].xShift();
    laws[i].a += reliefs[i].a() + edges[i].ahead;
  }
  return laws;
}

}  // namespace

ReliefWheel reliefWheelOf(const GrindProcess& p) {
  return {p.wheel_diameter / 2, p.wheel_wear,   p.wheel_width,
          p.setup_swivel,       p.setup_height, {p.wheel_corner_radius_lower, p.wheel_corner_radius_upper}};
}

ReliefStart reliefStartOf(const GrindJob& job, const ConicalCutter& tooth) {
  const CutterGeometry& c = job.cutter;
  if (job.process().kind == OperationKind::kPrimaryRelief) {
    return {c.clearance, 1, job.process().behind / tooth.radius(0)};
  }
  const GrindJob primary = job.ofOperation(1);
  const ReliefPath path(tooth, reliefStartOf(primary, tooth), reliefWheelOf(primary.process()));
  const ReliefPath::Place end = path.surfaceAt(0, c.land);
  if (!(end.radius > 0)) {
    throw std::invalid_argument(fieldName("cutter.land") + " = " + text(Quantity{c.land, Unit::kMetre}) +
                                ": the rim of the primary relief's wheel reaches only " +
                                text(Quantity{path.reach(), Unit::kMetre}, 3) +
                                " behind the edge; change the height of its set-up, or take a wider wheel");
  }
  return {c.second_clearance, end.radius / tooth.radius(0), end.behind};
}

EndPlane endPlaneOf(const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const double radius = c.end_diameter / 2;
  const OnTooth corner(0, radius, 0);
  switch (job.process().kind) {
    case OperationKind::kGash: return {gashNormal(c.end_rake, c.end_dish), corner};
    case OperationKind::kSecondaryEnd:
      return {endNormal(c.end_second_clearance, c.end_dish),
              corner + c.end_land * OnTooth(std::tan(c.end_clearance), 0, 1)};
    case OperationKind::kChamfer: {
      const double hand = c.cut == CutDirection::kRightHand ? 1 : -1, tan_rake = hand * std::tan(c.spiral_angle);
      // The flute's hook is behind the face of a gash, and lifts the end's edge there within the primary flank.
      const double tan_hook = std::max(0.0, std::tan(c.rake_angle));
      const double tan_dish = std::tan(c.end_dish) + tan_hook * std::tan(c.end_clearance);
      const double x = c.chamfer_width * (1 / std::tan(c.chamfer_angle) + tan_dish);
      const double behind = x * tan_rake / radius;
      return {chamferNormal(c.chamfer_angle, c.chamfer_clearance, std::atan(tan_dish), tan_rake, tan_hook),
              {x, radius * std::cos(behind), radius * std::sin(behind)}};
    }
    default: return {endNormal(c.end_clearance, c.end_dish), corner};
  }
}

GashBottom gashBottomOf(const GrindJob& job, int tooth) {
  const GrindProcess& p = job.process();
  if (!job.isShort(tooth)) return {p.gash_angle, p.gash_past};
  return {p.gash_short_angle > 0 ? p.gash_short_angle : p.gash_angle, p.gash_short_past};
}

double swivelOfPlane(const GrindJob& job) {
  const OnTooth normal = endPlaneOf(job).normal;
  const bool by_gash = job.process().kind == OperationKind::kGash;
  return (by_gash ? gashPose : flankPose)(normal, job.cutter.cut).swivel;
}

EndTooth endToothOf(const GrindJob& job, int tooth) {
  const std::vector<double>& angles = job.tooth_angles;
  const int next = job.behind(tooth);
  const double turn = angles.at(static_cast<std::size_t>(next)) - angles.at(static_cast<std::size_t>(tooth));
  const double way = job.cutter.cut == CutDirection::kRightHand ? turn : -turn;
  EndTooth end{job.cutter.end_diameter / 2, way > 0 ? way : way + units::kTurn, job.cutter.cut};
  if (!job.isShort(next)) return end;
  end.next_from = job.cutter.end_short_from;
  // As far as the rim passes the axis, it cuts every other edge to it. Behind the only such edge there is none to cut,
  // and it passes farther, to take that tooth's heel. With two teeth, farther past the axis is less far down.
  const bool cuts_edge = job.isShort(tooth) || job.cutter.end_center_teeth > 1;
  end.past_axis = cuts_edge ? kEndGap : end.next_from / (angles.size() > 2 ? 4 : 2);
  return end;
}

InvalidJob::InvalidJob(std::vector<Reason> reasons)
    : std::invalid_argument(text(reasons)), reasons_(std::move(reasons)) {}

ValidJob::ValidJob(GrindJob job) {
  std::vector<Reason> reasons = validate(job);
  if (!reasons.empty()) throw InvalidJob(std::move(reasons));
  Content content;
  content.digest = jobDigest(job);
  content.cutters.assign(job.tooth_angles.size(), job.cutter);
  for (std::size_t i = 0; i < job.spiral_angles.size(); ++i) content.cutters[i].spiral_angle = job.spiral_angles[i];
  if (isRelief(job.process().kind)) {
    content.job = std::move(job);
    takeReliefs(content, content.cutters);
  } else if (grinder::isStraight(job.process().kind)) {
    requireSwivelOfPlane(job);
    for (int tooth = 0; tooth < static_cast<int>(job.tooth_angles.size()); ++tooth) {
      requireFaceStroke(job, tooth);
      content.deepest = std::max(content.deepest, endStockOf(job, tooth));
    }
    content.job = std::move(job);
    takePasses(content);
  } else {
    content.deepest = job.process().deepest();
    if (!job.process().roughsByRemoval()) {
      content.depths = passDepths(job.process());
      content.passes = passesOf(job, content.depths);
    }
    content.laws = lawsOf(job, content.cutters, {}, {});
    content.job = std::move(job);
  }
  requireWheelLasts(content.job.process(), content.passes.size());
  if (content.job.process().z_law == ZLaw::kPublished) content.z_corrections.resize(content.cutters.size());
  content_ = std::make_shared<const Content>(std::move(content));
}

void ValidJob::takeReliefs(Content& content, const std::vector<CutterGeometry>& edges) {
  content.reliefs = reliefsOf(content.job, edges);
  content.deepest = 0;
  for (const ReliefPath& path : content.reliefs) content.deepest = std::max(content.deepest, path.depth());
  takePasses(content);
}

void ValidJob::takePasses(Content& content) {
  const GrindProcess& p = content.job.process();
  content.depths.clear();
  content.passes.clear();
  if (p.roughsByRemoval()) return;
  const double passes = content.deepest / p.infeed + p.spark_out + 2;
  if (!(passes * static_cast<double>(content.cutters.size()) <= kMaxPassesOfAll)) {
    throw InvalidJob(
        {otherReason("process.infeed_mm is too small for a " + std::string(rowOf(p.kind).words) +
                     " as deep as this: more than " + std::to_string(kMaxPassesOfAll) + " passes of all teeth")});
  }
  content.depths = passDepths(p, content.deepest);
  content.passes = passesOf(content.job, content.depths);
}

const std::vector<double>& ValidJob::depths() const {
  if (!hasPasses()) throw std::invalid_argument(kNoDepths);
  return content_->depths;
}

const std::vector<JobPass>& ValidJob::passes() const {
  if (!hasPasses()) throw std::invalid_argument(kNoDepths);
  return content_->passes;
}

ValidJob ValidJob::withRoughing(std::vector<double> depths) const {
  const GrindProcess& p = content_->job.process();
  ValidJob job = *this;
  Content content = *content_;
  content.depths = passDepths(p, content.deepest, std::move(depths));
  const std::size_t passes = content.depths.size() * content.cutters.size();
  if (passes > static_cast<std::size_t>(kMaxPassesOfAll)) {
    throw InvalidJob({otherReason(std::to_string(passes) + " passes of all teeth; allowed: up to " +
                                  std::to_string(kMaxPassesOfAll))});
  }
  requireWheelLasts(p, passes);
  content.passes = passesOf(content.job, content.depths);
  job.content_ = std::make_shared<const Content>(std::move(content));
  return job;
}

std::vector<double> ValidJob::wearOfTeeth() const {
  const GrindProcess& p = content_->job.process();
  if (p.wheel_wear_per_pass == 0) return std::vector<double>(content_->cutters.size(), wearAtStart(p));
  const auto deepest = std::max_element(depths().begin(), depths().end()) - depths().begin();
  std::vector<double> wear(content_->cutters.size());
  for (const JobPass& pass : passes()) {
    if (pass.place.pass == deepest) wear[static_cast<std::size_t>(pass.place.tooth)] = pass.wear;
  }
  return wear;
}

FaceWheel ValidJob::faceWheel(double wear) const noexcept { return faceWheelOf(content_->job.process(), wear); }

FaceStroke ValidJob::faceStroke(int tooth, double depth, double wear) const {
  if (content_->edges.empty()) throw std::invalid_argument(kNoEdges);
  const auto i = static_cast<std::size_t>(tooth);
  FaceStroke stroke = lastFaceStroke(content_->job, tooth, wear);
  const double deepest = content_->deepest, angle = content_->job.tooth_angles[i] + content_->edges[i].at_end;
  // A wheel that comes along X begins every pass clear of all that there was to grind.
  stroke.from += (content_->job.comesAlongX() ? deepest : deepest - depth) * stroke.per_stock;
  stroke.to += (deepest - depth) * stroke.per_stock;
  for (Axes* at : {&stroke.from, &stroke.to}) (*at)[kA] += angle;
  return stroke;
}

const StrokeLaw& ValidJob::strokeLaw(int tooth) const {
  if (content_->laws.empty()) {
    throw std::invalid_argument(kNoEdges);
  }
  return content_->laws.at(static_cast<std::size_t>(tooth));
}

DepthLaw ValidJob::depthLaw(int tooth, double depth, double wear) const noexcept {
  const GrindProcess& p = content_->job.process();
  if (const ReliefPath* path = relief(tooth)) {
    return {-path->y() - (content_->deepest - depth) + (wear - p.wheel_wear) * path->yPerWear(), path->taper()};
  }
  const double taper = (p.depth - p.depthEnd()) / content_->job.cutter.flute_length;
  return {depthAtEnd(depth) + wear, depth / content_->deepest * taper};
}

double ValidJob::depthAtEnd(double depth) const noexcept {
  const bool of_flute = content_->job.process().kind == OperationKind::kFlute;
  return of_flute ? depth * (content_->job.process().depth / content_->deepest) : depth;
}

const ReliefPath* ValidJob::relief(int tooth) const noexcept {
  return content_->reliefs.empty() ? nullptr : &content_->reliefs[static_cast<std::size_t>(tooth)];
}

ValidJob ValidJob::withEdges(const ValidJob& flutes, std::vector<EdgeHelix> edges) const {
  if (edges.size() != content_->cutters.size()) {
    throw std::invalid_argument(std::to_string(edges.size()) + " edges; allowed: " + std::to_string(teeth()) +
                                ", one for each tooth");
  }
  ValidJob job = *this;
  Content content = *content_;
  std::vector<CutterGeometry> as_ground = content.cutters;
  for (std::size_t i = 0; i < edges.size(); ++i) as_ground[i].spiral_angle = edges[i].spiral_angle;
  if (!isStraight()) {
    takeReliefs(content, as_ground);
    content.laws = lawsOf(content.job, content.cutters, content.reliefs, edges);
  }
  content.flutes = std::make_shared<const ValidJob>(flutes);
  content.edges = std::move(edges);
  job.content_ = std::make_shared<const Content>(std::move(content));
  return job;
}

ValidJob ValidJob::ofOperation(int index) const {
  return ValidJob(content_->job.ofOperation(index)).withEdges(flutes(), edges());
}

const ZCorrection& ValidJob::zCorrectionOf(int tooth) const {
  if (content_->z_corrections.empty()) {
    throw std::invalid_argument("process.z_law = constant_rake: its corrections of Z are not computed; see withLaws()");
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
