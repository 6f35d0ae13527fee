#include "flute_grinder/setup/job_setup.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/rounded_job.h"
#include "flute_grinder/tool/z_law.h"
#include "setup/relief_setup.h"

#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace grinder {

namespace {

constexpr int kMaxLengthenings = 4;  ///< maximum number of times that the overtravel is lengthened
constexpr double kSpare = 2e-5;      ///< addition for the precision of the required overtravel [m]
constexpr double kRoom = 0.02;       ///< additional overtravel for a law of Z, as a fraction of the flute's length

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

/// A number as written to a file, without trailing zeros.
std::string textOf(double value, double scale, int decimals) {
  std::string number = format("%.*f", decimals, value / scale);
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number == "-0" ? "0" : number;
}

std::string asked(const char* path, double value, Unit unit) {
  return fieldName(path) + " = " + text(Quantity{value, unit}, 5);
}

std::string range(const SetupRefusal& r, Unit unit) { return text(Quantity{r.min, unit}, Quantity{r.max, unit}, 5); }

std::string textOf(const SetupRefusal::Nearest& nearest, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const auto line = [](const std::string& name, double value, const Range& had, double tolerance, Unit unit) {
    const auto shown = [&](double si) { return text(Quantity{si, unit}, 3); };
    return "\n  " + name + " = " + text(Quantity{value, unit}, 5) + " within " + shown(tolerance) + ": " +
           shown(had.from) + (had.to == had.from ? "" : " to " + shown(had.to));
  };
  const auto key = [](const char* path) { return fieldName(path); };
  const auto& [core, end] = nearest.core_diameter;
  return line(key("cutter.rake_angle"), c.rake_angle, nearest.rake, c.rake_tolerance, Unit::kRadian) +
         line(rowOf(ToolFigure::kChordalRake).words, c.rake_angle, nearest.chordal_rake, c.chordal_rake_tolerance,
              Unit::kRadian) +
         line(key("cutter.spiral_angle"), c.spiral_angle, nearest.spiral, c.spiral_tolerance, Unit::kRadian) +
         line(key("cutter.core_diameter"), c.core_diameter, {core, core}, c.core_tolerance, Unit::kMetre) +
         line(key("cutter.core_diameter_end"), c.core_diameter_end, {end, end}, c.core_tolerance, Unit::kMetre);
}

std::string textOf(const SetupRefusal::Mend& mend, const GrindJob& job) {
  const auto figure = [](const char* path, double value) {
    return fieldName(path) + " = " + textOf(value, units::kMillimetre, 3);
  };
  if (mend.wheel_diameter > 0) {
    return "\nIt would be set up with " +
           figure("process.wheel_diameter", mend.wheel_diameter + 2 * job.process().wheel_wear);
  }
  if (mend.wheel_width > 0) return "\nIt would be set up with " + figure("process.wheel_width", mend.wheel_width);
  if (mend.core_diameter[0] > 0) {
    return "\nIt would be set up with " + figure("cutter.core_diameter", mend.core_diameter[0]) + " and " +
           figure("cutter.core_diameter_end", mend.core_diameter[1]);
  }
  return "\nNo smaller or narrower wheel and no other core was found to mend it";
}

std::string textOf(const SetupRefusal& r, const GrindJob& job, std::optional<SetupFigure> keep) {
  const std::string change = "; change " + fieldName(rowOf(r.problem).change);
  switch (r.problem) {
    case SetupProblem::kSwivel:
      return keep == SetupFigure::kSwivel
                 ? asked("process.setup_swivel", r.asked, Unit::kRadian) + "; the machine swivels " +
                       range(r, Unit::kRadian) + "; change it"
                 : "the set-up takes a swivel of " + text(Quantity{r.asked, Unit::kRadian}, 5) +
                       "; the machine swivels " + range(r, Unit::kRadian) + change;
    case SetupProblem::kReach: return "this wheel reaches the cutter in no set-up" + change;
    case SetupProblem::kCore: return "the wheel cuts through the core" + change;
    case SetupProblem::kWall:
      return "the wheel's circumference would form the rake face, not its face or edge; it can in no set-up with this "
             "depth" +
             change;
    case SetupProblem::kTolerance:
      return "no set-up gives all that is asked within its tolerance; the nearest one gives for" +
             textOf(r.nearest, job) + textOf(r.mend, job);
    case SetupProblem::kLand:
      return "no land is left: the flutes overlap by " + text(Quantity{-r.min, Unit::kMetre}, 3) + " along the circle" +
             change + (r.mend.wheel_width > 0 ? textOf(r.mend, job) : "");
    case SetupProblem::kIncomplete:
      return "near the cone's apex no overtravel makes the flute complete" + change + ", or set " +
             fieldName("process.incomplete_ok");
  }
  return "";
}

SetupRequest requestOf(const GrindJob& job, const Range& swivel, std::optional<SetupFigure> keep) {
  const GrindProcess& p = job.process();
  SetupRequest r;
  r.cutter = job.cutter;
  r.cutter.spiral_angle = (askedSpiral(job).from + askedSpiral(job).to) / 2;
  r.rake = job.cutter.rake_angle;
  r.tooth_angles = job.tooth_angles;
  r.wheel = wheelOf(job).worn(p.wheel_wear);
  r.nominal_radius = p.wheel_diameter / 2 - p.wheel_wear;  // Y follows the wear
  r.depth = p.depth;
  const CutterGeometry& c = job.cutter;
  r.core_diameter = c.core_diameter;
  r.core_diameter_end = c.core_diameter_end;
  // A first taper from the asked cores.
  r.y_per_x = (c.core_diameter_end - c.core_diameter) / 2 / c.flute_length - std::tan(c.cone_angle);
  r.incomplete_ok = p.incomplete_ok;
  r.asks_spiral = true;
  r.min_swivel = swivel.from;
  r.max_swivel = swivel.to;
  r.keep = keep;
  r.kept = {p.setup_swivel, p.setup_height};
  r.z_law = p.z_law;
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

/// Puts the solved figures into the job, as read back from a file. A fixed depth keeps its decimals.
void take(const SolvedSetup& solved, std::optional<SetupFigure> keep, JobSetup& setup) {
  GrindProcess& p = setup.job.process();
  const auto millimetres = [](double value) { return rounded(value, units::kMillimetre, kLengthDecimals); };
  if (keep != SetupFigure::kDepth) p.depth = millimetres(solved.depth);
  if (keep != SetupFigure::kSwivel) p.setup_swivel = rounded(solved.setup.swivel, units::kDegree, kAngleDecimals);
  if (keep != SetupFigure::kHeight) p.setup_height = millimetres(solved.setup.height);
  // A flute of constant depth needs no depth at its end.
  if (p.depth_end > 0 || solved.depth_end != solved.depth) p.depth_end = millimetres(solved.depth_end);
  p.setup_x_shift = millimetres(solved.setup.x_shift);
  setup.overtravel = solved.overtravel;
  takeOvertravel(setup);
  setup.limit = solved.limit;
  setup.margin = solved.margin;
}

bool hasLaws(const ValidJob& job) {
  try {
    withLaws(job);
    return true;
  } catch (const ReasonError&) {
    return false;
  }
}

/// Lengthens the overtravel by more than a law of Z needs: an incomplete flute may have no such law.
void giveRoom(JobSetup& setup) {
  for (double& beyond : setup.overtravel) {
    if (beyond > 0) beyond += kRoom * setup.job.cutter.flute_length;
  }
  takeOvertravel(setup);
}

/// Lengthens the overtravel by what is missing: the solver knows the published law of Z, and another law moves the
/// places of the stroke where the flute's ends are formed.
/// @return whether it was too short. Near a cone's apex, where no overtravel is enough, it stays.
bool lengthenOvertravel(const SolvedSetup& solved, JobSetup& setup) {
  const GrindProcess& p = setup.job.process();
  const double length = setup.job.cutter.flute_length;
  const auto& complete = setup.check.complete;
  if (!complete || solved.complete_from > 0 || solved.complete_to < length) return false;
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
  const ReliefSetup found = findReliefSetup(job, flutes, swivel, asked);
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

/// The job with a solved set-up, and the tool that it grinds.
JobSetup setupWith(const SolvedSetup& solved, const GrindJob& job, std::optional<SetupFigure> keep) {
  JobSetup setup;
  setup.job = job;
  take(solved, keep, setup);
  for (int i = 0;; ++i) {
    const ValidJob valid(setup.job);
    if (i == 0 && !hasLaws(valid)) {
      giveRoom(setup);
      continue;
    }
    setup.check = checkGroundCutter(withLaws(valid));
    if (i == kMaxLengthenings || !lengthenOvertravel(solved, setup)) return setup;
  }
}

/// Whether a plan's check accepts a job with a solved set-up.
bool isAccepted(const SolvedSetup& solved, const GrindJob& job, std::optional<SetupFigure> keep) {
  try {
    return setupWith(solved, job, keep).check.reasons.empty();
  } catch (const std::invalid_argument&) {  // the job is then not valid, or has no law of Z
    return false;
  }
}

std::variant<JobSetup, std::string> solveFluteSetup(const GrindJob& job, const Range& swivel,
                                                    std::optional<SetupFigure> keep) {
  SetupRequest request = requestOf(job, swivel, keep);
  request.accepts = [&](const SolvedSetup& solved) { return isAccepted(solved, job, keep); };
  const auto result = solveSetup(request);
  if (const auto* refusal = std::get_if<SetupRefusal>(&result)) return textOf(*refusal, job, keep);
  return setupWith(std::get<SolvedSetup>(result), job, keep);
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
    auto found =
        isRelief(job.process().kind) ? solveReliefSetup(job, swivel, keep) : solveFluteSetup(job, swivel, keep);
    if (auto* setup = std::get_if<JobSetup>(&found)) *setup = inJob(asked, std::move(*setup), keep);
    return found;
  } catch (const InvalidJob& error) {
    return "the set-up does not suit the job: " + text(error.reasons());
  } catch (const std::invalid_argument& error) {
    return std::string(error.what());
  }
}

}  // namespace grinder
