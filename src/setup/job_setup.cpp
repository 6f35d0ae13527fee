#include "flute_grinder/setup/job_setup.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/rounded_job.h"
#include "flute_grinder/tool/z_law.h"
#include "setup/flute_setup.h"
#include "setup/relief_setup.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

namespace grinder {

namespace {

constexpr int kMaxLengthenings = 4;  ///< maximum number of times that the overtravel is lengthened
constexpr double kSpare = 2e-5;      ///< addition for the precision of the required overtravel [m]
/// Tolerances, per asked tolerance, within which set-ups for a correction of Z are sought: for the rake, and for spiral
/// angle and core. A correction changes core and edge so much that other set-ups may suit it.
constexpr double kRakeForCorrection = 4, kOthersForCorrection = 0.8;

// Decimals in a file. The rake changes by up to 1/R per height (0.0006 deg for 10 nm at a radius of 1 mm), and by a few
// times the change of the swivel.
constexpr int kAngleDecimals = 4;
constexpr int kLengthDecimals = 5;
constexpr int kOvertravelDecimals = 2;

/// A value as read back from a file with so many decimals [SI].
double rounded(double value, double scale, int decimals) {
  const double unit = std::pow(10, decimals);
  return std::round(value / scale * unit) / unit * scale;
}

/// What would make the tool possible, for the operator.
std::string textOf(const FluteRemedy& remedy, const GrindProcess& p) {
  const auto figure = [](const char* path, double value) {
    return fieldName(path) + " = " + format("%g", std::round(value / units::kMicrometre) / 1000);
  };
  const auto& [core, end] = remedy.core_diameter;
  if (remedy.less_diameter > 0) return figure("process.wheel_diameter", p.wheel_diameter - remedy.less_diameter);
  if (remedy.less_width > 0) return figure("process.wheel_width", p.wheel_width - remedy.less_width);
  if (core > 0) return figure("cutter.core_diameter", core) + " and " + figure("cutter.core_diameter_end", end);
  return "";
}

std::string machineText(const Range& swivel) {
  return "the machine swivels " + text(Quantity{swivel.from, Unit::kRadian}, Quantity{swivel.to, Unit::kRadian}, 5);
}

/// Refuses a set-up that the machine cannot be swivelled to.
/// @param path field that the swivel depends on.
std::string swivelBeyond(double needed, const Range& swivel, const char* path) {
  return "the set-up takes a swivel of " + text(Quantity{needed, Unit::kRadian}, 5) + "; " + machineText(swivel) +
         "; change " + fieldName(path);
}

/// The minimum angle from one tooth to the next.
double minPitch(const std::vector<double>& angles) {
  double min = angles.front() + units::kTurn - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) min = std::min(min, angles[i] - angles[i - 1]);
  return min;
}

/// 1, or -1 for a left-hand cutter, which is set up as the mirror image of a right-hand one.
double handOf(const GrindJob& job) { return job.cutter.cut == CutDirection::kRightHand ? 1 : -1; }

/// The part of a machine's range in which the set-ups of flutes and reliefs are sought.
Range ofPeriphery(const Range& machine) {
  return {std::max(machine.from, -kWidestSwivel), std::min(machine.to, kWidestSwivel)};
}

FluteRequest requestOf(const GrindJob& job, const Range& swivel, std::optional<SetupFigure> keep) {
  const GrindProcess& p = job.process();
  const double hand = handOf(job);
  const Range spiral = askedSpiral(job);
  const WheelProfile wheel = wheelOf(job).worn(p.wheel_wear);
  FluteRequest r{job.cutter, minPitch(job.tooth_angles), hand > 0 ? wheel : wheel.mirrored(), 0, swivel, keep, {}};
  r.cutter.cut = CutDirection::kRightHand;
  r.cutter.spiral_angle = hand * (spiral.from + spiral.to) / 2;
  r.nominal_radius = p.wheel_diameter / 2 - p.wheel_wear;  // Y follows the wear
  if (hand < 0) r.swivel = {-swivel.to, -swivel.from};
  r.kept.swivel = hand * p.setup_swivel;
  r.kept.height = hand * p.setup_height;
  r.kept.depth = p.depth;
  return r;
}

/// Lengthens the overtravel to the set-up's requirement, where it is shorter.
void takeOvertravel(JobSetup& setup) {
  GrindProcess& p = setup.job.process();
  const auto lengthen = [](double& field, double needed) {
    if (field >= needed) return;
    const double up = std::pow(10, -kOvertravelDecimals) / 2 * units::kMillimetre;
    field = rounded(needed + up, units::kMillimetre, kOvertravelDecimals);
  };
  lengthen(p.overtravel_end, setup.overtravel[0]);
  lengthen(p.overtravel_shank, setup.overtravel[1]);
}

/// Puts the figures of a set-up into the job, as read back from a file. A figure that stays keeps its decimals.
void take(const JudgedFlute& found, std::optional<SetupFigure> keep, JobSetup& setup) {
  GrindProcess& p = setup.job.process();
  const SetupPoint& point = found.point;
  const double hand = handOf(setup.job);
  const auto millimetres = [](double value) { return rounded(value, units::kMillimetre, kLengthDecimals); };
  if (keep != SetupFigure::kDepth) p.depth = millimetres(point.depth);
  if (keep != SetupFigure::kSwivel) p.setup_swivel = rounded(hand * point.swivel, units::kDegree, kAngleDecimals);
  if (keep != SetupFigure::kHeight) p.setup_height = millimetres(hand * point.height);
  // A flute of constant depth needs no depth at its end.
  p.depth_end = point.taper == 0 ? 0 : millimetres(point.depth - point.taper * setup.job.cutter.flute_length);
  p.setup_x_shift = millimetres(point.x_shift);
  setup.overtravel = found.overtravel;
  takeOvertravel(setup);
}

/// Lengthens the overtravel by what is missing: the solver knows the published law of Z, and another law moves the
/// places of the stroke where the flute's ends are formed.
/// @return whether it was too short. Near a cone's apex, where no overtravel is enough, it stays.
bool lengthenOvertravel(const JudgedFlute& found, JobSetup& setup) {
  const GrindProcess& p = setup.job.process();
  const double length = setup.job.cutter.flute_length;
  const auto& complete = setup.check.complete;
  if (!complete || !found.complete) return false;
  if (complete->from > 0) setup.overtravel[0] = p.overtravel_end + complete->from + kSpare;
  if (complete->to < length) setup.overtravel[1] = p.overtravel_shank + length - complete->to + kSpare;
  takeOvertravel(setup);
  return complete->from > 0 || complete->to < length;
}

std::variant<JobSetup, std::string> solveReliefSetup(const GrindJob& job, const Range& swivel,
                                                     std::optional<SetupFigure> keep) {
  if (keep && *keep != SetupFigure::kSwivel) {
    return std::string("the ") + toString(*keep) + " of a relief is not kept; allowed: swivel";
  }
  const ValidJob flutes = withLaws(ValidJob(job.ofOperation(0)));
  const auto asked = keep ? std::optional(job.process().setup_swivel) : std::nullopt;
  const ReliefSetup found = findReliefSetup(job, flutes, ofPeriphery(swivel), asked);
  if (!found.refused.empty()) {
    return "no set-up grinds this relief; at a swivel of " + text(Quantity{found.swivel, Unit::kRadian}, 5) + ", " +
           found.refused;
  }
  JobSetup setup;
  setup.job = job;
  GrindProcess& p = setup.job.process();
  if (!keep) p.setup_swivel = rounded(found.swivel, units::kDegree, kAngleDecimals);
  p.setup_height = rounded(found.height, units::kMillimetre, kLengthDecimals);
  setup.relief = JobSetup::Relief{found.width, found.next_edge, found.land_end_clearance};
  setup.check = checkGroundCutter(withLaws(ValidJob(setup.job)));
  return setup;
}

/// The key of a plane's angle.
const char* angleOfPlane(OperationKind kind) {
  switch (kind) {
    case OperationKind::kGash: return "cutter.end_rake";
    case OperationKind::kSecondaryEnd: return "cutter.end_second_clearance";
    case OperationKind::kChamfer: return "cutter.chamfer_angle";
    default: return "cutter.end_clearance";
  }
}

JobSetup::Straight straightOf(const ValidJob& job) {
  JobSetup::Straight straight;
  straight.last = job.faceStroke(0, job.deepest(), job.passes().front().wear);
  straight.passes = static_cast<int>(job.depths().size());
  straight.stock = job.deepest();
  straight.past_axis = -(straight.last.to[kY] + job->cutter.end_diameter / 2 + job->process().wheel_wear);
  Axes least = straight.last.to, most = least;
  for (const JobPass& pass : job.passes()) {
    const FaceStroke stroke = job.faceStroke(pass.place.tooth, pass.depth, pass.wear);
    least = least.min(stroke.from).min(stroke.to);
    most = most.max(stroke.from).max(stroke.to);
  }
  straight.travel = most - least;
  return straight;
}

/// The height at which Z is 0 at the end of the last stroke; the mean over the teeth, or the nearest allowed one [m].
/// @param job with height 0.
double heightOfStrokes(const ValidJob& job) {
  double height = 0;
  for (int i = 0; i < job.teeth(); ++i) {
    height += job.faceStroke(i, job.deepest(), job.passes().front().wear).to[kZ] / job.teeth();
  }
  visitJobFields([&](const JobField& field, auto) {
    if (std::string_view(field.path) == "process.setup_height") {
      height = std::clamp(height, field.low().si, field.high().si);
    }
  });
  return rounded(height, units::kMillimetre, kLengthDecimals);
}

std::variant<JobSetup, std::string> solveStraightSetup(const GrindJob& job, const Range& swivel,
                                                       std::optional<SetupFigure> keep) {
  const OperationKind kind = job.process().kind;
  const std::string words = rowOf(kind).words;
  if (keep) return "the " + std::string(toString(*keep)) + " of a " + words + " is not kept; allowed: none";
  if (std::vector<Reason> reasons = validate(job); !reasons.empty()) throw InvalidJob(std::move(reasons));
  JobSetup setup;
  setup.job = job;
  GrindProcess& p = setup.job.process();
  p.setup_swivel = rounded(swivelOfPlane(job), units::kDegree, kAngleDecimals);
  if (!(p.setup_swivel >= swivel.from && p.setup_swivel <= swivel.to)) {
    return swivelBeyond(p.setup_swivel, swivel, angleOfPlane(kind));
  }
  p.setup_height = 0;
  p.setup_height = heightOfStrokes(withLaws(ValidJob(setup.job)));
  const ValidJob solved = withLaws(ValidJob(setup.job));
  setup.straight = straightOf(solved);
  setup.check = checkGroundCutter(solved);
  return setup;
}

/// The limit that the set-up is nearest to.
void findLimit(const Range& swivel, JobSetup& setup) {
  const CutterGeometry& c = setup.job.cutter;
  const double at = setup.job.process().setup_swivel;
  const auto least = [&](ToolFigure figure) {
    const GroundFigure* found = find(setup.check.figures, figure);
    return found ? found->least.value : 0;
  };
  const std::pair<SetupLimit, double> margins[] = {
      {SetupLimit::kSwivel, std::min(at - swivel.from, swivel.to - at) / (swivel.to - swivel.from)},
      {SetupLimit::kLand, least(ToolFigure::kLand) / (minPitch(setup.job.tooth_angles) * c.end_diameter / 2)},
      {SetupLimit::kCore, least(ToolFigure::kCoreDiameter) / c.end_diameter}};
  std::tie(setup.limit, setup.margin) = *std::min_element(
      std::begin(margins), std::end(margins), [](const auto& a, const auto& b) { return a.second < b.second; });
}

/// The job with a set-up, and the tool that it grinds.
JobSetup setupWith(const JudgedFlute& found, const GrindJob& job, std::optional<SetupFigure> keep) {
  JobSetup setup;
  setup.job = job;
  take(found, keep, setup);
  for (int i = 0;; ++i) {
    setup.check = checkGroundCutter(withLaws(ValidJob(setup.job)));
    if (i == kMaxLengthenings || !lengthenOvertravel(found, setup)) return setup;
  }
}

/// Whether a plan's check accepts a job with a set-up.
bool isAccepted(const JudgedFlute& found, const GrindJob& job, std::optional<SetupFigure> keep) {
  try {
    return setupWith(found, job, keep).check.reasons.empty();
  } catch (const std::invalid_argument&) {  // the job is then not valid, or has no law of Z
    return false;
  }
}

FoundFlute findFlute(const FluteRequest& request, const GrindJob& job) {
  const auto accepts = [&](const JudgedFlute& found) { return isAccepted(found, job, request.keep); };
  FoundFlute found = findFluteSetup(request, accepts);
  if (found.accepted || job.process().z_law == ZLaw::kPublished) return found;
  FluteRequest wider = request;
  wider.cutter.rake_tolerance *= kRakeForCorrection;
  wider.cutter.spiral_tolerance *= kOthersForCorrection;
  wider.cutter.core_tolerance *= kOthersForCorrection;
  FoundFlute corrected = findFluteSetup(wider, accepts);
  return corrected.accepted ? corrected : found;
}

std::variant<JobSetup, std::string> solveFluteSetup(const GrindJob& job, const Range& swivel,
                                                    std::optional<SetupFigure> keep) {
  const double kept = job.process().setup_swivel;
  if (keep == SetupFigure::kSwivel && !(kept >= swivel.from && kept <= swivel.to)) {
    return fieldName("process.setup_swivel") + " = " + text(Quantity{kept, Unit::kRadian}, 5) + "; " +
           machineText(swivel) + "; change it";
  }
  const FluteRequest request = requestOf(job, ofPeriphery(swivel), keep);
  const FoundFlute found = findFlute(request, job);
  if (found.swivel_beyond) {
    return swivelBeyond(handOf(job) * *found.swivel_beyond, swivel, "cutter.spiral_angle");
  }
  if (!found.best) {
    return "this wheel reaches the cutter in no set-up; change " + fieldName("process.wheel_diameter");
  }
  JobSetup setup = setupWith(*found.best, job, keep);
  findLimit(swivel, setup);
  if (!found.accepted) setup.remedy = textOf(remedyFor(request, found.best->point), job.process());
  return setup;
}

/// Transfers the set-up found for a job with rounded numbers to the job itself.
JobSetup inJob(GrindJob job, JobSetup setup, std::optional<SetupFigure> keep) {
  visitJobFields([&](const JobField& field, auto of) {
    const bool is_kept = keep && field.path == std::string_view(rowOf(*keep).path);
    if (isOfSetup(field) && !is_kept) of(job) = of(setup.job);
  });
  setup.job = std::move(job);
  return setup;
}

}  // namespace

std::variant<JobSetup, std::string> solveJobSetup(const GrindJob& asked, const Range& swivel,
                                                  std::optional<SetupFigure> keep) {
  const GrindJob job = roundedOff(asked);
  try {
    const OperationKind kind = job.process().kind;
    auto found = isRelief(kind)     ? solveReliefSetup(job, swivel, keep)
                 : isStraight(kind) ? solveStraightSetup(job, swivel, keep)
                                    : solveFluteSetup(job, swivel, keep);
    if (auto* setup = std::get_if<JobSetup>(&found)) *setup = inJob(asked, std::move(*setup), keep);
    return found;
  } catch (const InvalidJob& error) {
    return "the set-up does not suit the job: " + text(error.reasons());
  } catch (const std::invalid_argument& error) {
    return std::string(error.what());
  }
}

}  // namespace grinder
