#include "flute_grinder/tool/ground_job.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/log_curve.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/pass_removal.h"
#include "flute_grinder/tool/z_law.h"
#include "tool/end_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace grinder {

namespace {

constexpr int kSections = 8;      ///< number of intervals between the measured sections of the flute
constexpr int kRingsToSpoil = 6;  ///< rings of a section at which a stroke may spoil it
constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
constexpr double kSameWear = 20e-6;  ///< difference of wear that changes a check negligibly, by the curvature [m]

std::array<double, 2> cornerRadii(const GrindProcess& p) {
  return {p.wheel_corner_radius_lower, p.wheel_corner_radius_upper};
}

/// See WheelSweep::overcutStart(), for the first of some circles of a section.
std::optional<double> sectionSpoilsFrom(const WheelSweep& sweep, double x, double radius) {
  std::optional<double> first = sweep.overcutStart(x, radius);
  if (!first) return first;  // the wheel reaches no other circle from farther away
  const double core = sweep.minRadius(x, radius);
  for (int i = 1; i < kRingsToSpoil; ++i) {
    const auto here = sweep.overcutStart(x, core + (radius - core) * i / kRingsToSpoil);
    if (here && std::abs(*here - x) < std::abs(*first - x)) first = here;
  }
  return first;
}

/// The edge of a tooth, from the sections that have one.
GroundEdge edgeOf(const ValidJob& job, std::size_t tooth, const std::vector<GroundSection>& sections) {
  const StrokeLaw& law = job.strokeLaw(static_cast<int>(tooth));
  const LogCurve curve(ConicalCutter(law.cutter), law.x_shift);
  std::vector<GroundEdge::Place> places;
  for (const GroundSection& section : sections) {
    const ToothSection& at = section.teeth[tooth];
    if (!at.edge) continue;
    double wheel_x = job.relief(0) != nullptr ? section.x + law.x_shift : at.edge_wheel_x;
    // Sections formed by the stroke's end have inexact extrema; the order is kept.
    if (!places.empty()) wheel_x = std::max(wheel_x, places.back().wheel_x);
    places.push_back({section.x, wheel_x, *at.edge - law.a - curve.a(wheel_x)});
  }
  return GroundEdge(std::move(places));
}

/// Collects the faults of a cutter.
class Checker {
 public:
  explicit Checker(const ValidJob& job) : job_(job) {}

  void check(const GroundSection& section) {
    if (job_.relief(0) != nullptr) {
      for (std::size_t i = 0; i < section.teeth.size(); ++i) checkRelief(section, i);
      return checkReliefCore(section);
    }
    if (!(section.core_radius > kMinCore)) add(ReasonKind::kCore, section.x, 0, Unit::kMetre, section.core_radius, 0);
    for (std::size_t i = 0; i < section.teeth.size(); ++i) checkFlute(section, i);
    const auto complete = [](const ToothSection& tooth) { return tooth.complete; };
    checkCore(section, std::all_of(section.teeth.begin(), section.teeth.end(), complete));
  }

  /// Checks the turn of the edges between two sections. It is within the tolerance if each edge's angle is so
  /// everywhere.
  void checkTurn(const GroundSection& from, const GroundSection& to) {
    if (job_.relief(0) != nullptr) return;
    for (std::size_t i = 0; i < to.teeth.size(); ++i) {
      if (!from.teeth[i].complete || !to.teeth[i].complete) continue;
      const double turn = *to.teeth[i].edge - *from.teeth[i].edge;
      const double mean = meanSpiral(ConicalCutter(job_->cutter), from.x, to.x, turn);
      const double tolerance = job_->cutter.spiral_tolerance;
      const int number = static_cast<int>(i);
      const double asked = job_.cutterOf(number).spiral_angle;
      if (std::abs(mean - asked) <= tolerance) continue;
      add(ReasonKind::kSpiral, (from.x + to.x) / 2, number, Unit::kRadian, mean, asked, tolerance);
    }
  }

  void checkRange(const std::optional<Range>& complete) {
    if (job_.relief(0) != nullptr) return;
    const double length = job_->cutter.flute_length;
    if (job_->process().incomplete_ok || (complete && complete->from <= 0 && complete->to >= length)) return;
    const Range range = complete.value_or(Range{});
    add(ReasonKind::kIncomplete, 0, 0, Unit::kMetre, range.to, length, range.from);
  }

  /// Checks that the stroke does not go so near to the cone's apex that it spoils the flute.
  void checkOvertravel(const GroundCutter& cutter) {
    if (job_.relief(0) != nullptr) return;
    const bool opens = cutter.cutter().tanCone() >= 0;
    const double nearest = opens ? 0 : job_->cutter.flute_length;
    for (const Flute& flute : cutter.flutes()) {
      for (const WheelSweep& sweep : flute) {
        const auto spoils = sectionSpoilsFrom(sweep, nearest, cutter.cutter().radius(nearest));
        if (!spoils) continue;
        const double overtravel = opens ? job_->process().overtravel_end : job_->process().overtravel_shank;
        const double limit = std::abs(*spoils - nearest);
        if (overtravel < limit) continue;
        return reasons_.push_back(
            {ReasonKind::kNotBelow, 0, opens ? "process.overtravel_end" : "process.overtravel_shank",
             "where the wheel, near the cone's apex, grinds into the flute again", Unit::kMetre, overtravel, 0, limit});
      }
    }
  }

  /// The first reason of each kind: a fault of the set-up shows in every section of every tooth.
  std::vector<Reason> take() { return std::move(reasons_); }

 private:
  /// Checks the figures of the planned operation. An edge has no spiral angle at the cone's apex.
  void checkFigures(const FigurePlace& place) {
    for (const ToolFigureRow& row : kToolFigures) {
      const ToolFigure figure = row.value;
      if (row.reason == ReasonKind::kNone || row.of != rowOf(job_->process().kind).form) continue;
      if (row.of_complete && !place.tooth().complete) continue;
      if (isAsAsked(figure, place) || (figure == ToolFigure::kSpiral && !place.tooth().spiral)) continue;
      add(row.reason, place.section.x, static_cast<int>(place.number), row.unit,
          measured(figure, place).value_or(kNoFigure), *asked(figure, place), tolerance(figure, place));
    }
  }

  void checkFlute(const GroundSection& section, std::size_t i) {
    const ToothSection& tooth = section.teeth[i];
    if (tooth.flute && !tooth.land) {
      add(ReasonKind::kLand, section.x, static_cast<int>(i), Unit::kRadian, pitch(i) - tooth.least_land, pitch(i));
    }
    checkFigures({job_, section, i});
  }

  /// Checks a relief. A primary relief may end on the land if a secondary one follows, but behind the secondary's
  /// start.
  void checkRelief(const GroundSection& section, std::size_t i) {
    const int number = static_cast<int>(i);
    const ReliefSection relief = section.teeth[i].relief.value_or(ReliefSection{});
    checkFigures({job_, section, i});
    if (!(relief.next_edge > 0)) {
      add(ReasonKind::kNextEdge, section.x, number, Unit::kRadian, -relief.next_edge, 0);
    }
    const bool secondary = job_->process().kind == OperationKind::kSecondaryRelief;
    const GrindProcess* next = job_->next();
    const bool last = next == nullptr || !isRelief(next->kind);
    const bool is_wide =
        last ? relief.heel.has_value() : job_.relief(number)->surfaceAt(0, job_->cutter.land).radius > 0;
    if (!is_wide || (secondary && !relief.land)) {
      add(ReasonKind::kHeel, section.x, number, Unit::kMetre, 0, 0);
    }
  }

  /// Checks the core. Where a flute is not complete, only a core that is too thick is a fault.
  void checkCore(const GroundSection& section, bool complete) {
    const double core = 2 * section.core_radius, asked = askedCore(job_->cutter, section.x);
    const double tolerance = job_->cutter.core_tolerance;
    if (core >= asked - tolerance && (!complete || core <= asked + tolerance)) return;
    add(ReasonKind::kCoreSize, section.x, 0, Unit::kMetre, core, asked, tolerance);
  }

  /// Checks the core that reliefs leave; the flutes' core is checked with them.
  void checkReliefCore(const GroundSection& section) {
    const auto least = [&](const ToothSection& t) { return t.relief && t.relief->core_radius <= section.core_radius; };
    if (std::none_of(section.teeth.begin(), section.teeth.end(), least)) return;
    const double core = 2 * section.core_radius, asked = askedCore(job_->cutter, section.x);
    const double tolerance = job_->cutter.core_tolerance;
    if (core >= asked - tolerance) return;
    add(ReasonKind::kCoreSize, section.x, 0, Unit::kMetre, core, asked, tolerance,
        "the height or the swivel of the relief's set-up");
  }

  /// The angle from a tooth to the one whose flute bounds its land [rad].
  double pitch(std::size_t tooth) const {
    const std::vector<double>& angles = job_->tooth_angles;
    const std::size_t before =
        job_->cutter.cut == CutDirection::kRightHand ? tooth : (tooth + angles.size() - 1) % angles.size();
    return (before + 1 < angles.size() ? angles[before + 1] : 2 * units::kPi) - angles[before];
  }

  void add(ReasonKind kind, double x, int tooth, Unit unit, double value, double limit, double low = 0,
           const char* detail = "") {
    const auto same = [&](const Reason& r) { return r.kind == kind; };
    if (std::any_of(reasons_.begin(), reasons_.end(), same)) return;
    Reason& reason = reasons_.emplace_back(Reason{kind, 0, "", detail, unit, value, low, limit});
    reason.x = x;
    reason.tooth = tooth;
  }

  const ValidJob& job_;
  std::vector<Reason> reasons_;
};

/// ValidJob::wearOfTeeth(), also of a job without its passes [m].
std::vector<double> wearInDeepestPasses(const ValidJob& job, const PlanWatch& watch) {
  return job->process().wheel_wear_per_pass > 0 ? withPasses(job, watch).wearOfTeeth() : job.wearOfTeeth();
}

/// Adds the reliefs of a job, up to an operation, to flutes.
/// @param flutes cutter with the flutes.
GroundCutter relievedCutterOf(const ValidJob& job, const GroundCutter& flutes, int last, const PlanWatch& watch) {
  std::vector<Reliefs> reliefs(flutes.flutes().size());
  for (int i = 1; i <= last; ++i) {
    const ValidJob relief = i == job->operation ? job : job.ofOperation(i);
    const std::vector<double> wear = wearInDeepestPasses(relief, watch);
    for (std::size_t tooth = 0; tooth < wear.size(); ++tooth) {
      Reliefs& own = reliefs[flutes.teeth()[tooth].flute];
      if (own.size() >= static_cast<std::size_t>(i)) continue;  // a tooth that shares the flute has added it
      const int number = static_cast<int>(tooth);
      own.push_back({sweepOf(relief, number, wear[tooth], strokeOf(relief, number, relief.deepest(), wear[tooth]))});
    }
  }
  return GroundCutter(flutes.cutter(), flutes.flutes(), flutes.teeth(), std::move(reliefs), flutes.chordalRakeDepth());
}

/// The number of the last relief up to a job's operation; 0 if there is none.
int lastReliefOf(const GrindJob& job) {
  int last = job.operation;
  while (last > 0 && !isRelief(job.operations[static_cast<std::size_t>(last)].kind)) --last;
  return last;
}

/// @param same_wear maximum difference of the wheel's wear for teeth to share a flute [m].
GroundCutter groundCutterOf(const ValidJob& job, double same_wear, const PlanWatch& watch) {
  if (job->process().kind != OperationKind::kFlute) {
    return relievedCutterOf(job, groundCutterOf(job.flutes(), same_wear, watch), lastReliefOf(*job), watch);
  }
  const std::vector<double> wear = wearInDeepestPasses(job, watch);
  std::vector<Flute> flutes;
  std::vector<GroundTooth> teeth;
  const auto spiral = [&](std::size_t i) { return job.cutterOf(static_cast<int>(i)).spiral_angle; };
  for (std::size_t i = 0; i < job->tooth_angles.size(); ++i) {
    std::size_t same = 0;
    while (same < i && !(std::abs(wear[same] - wear[i]) <= same_wear && spiral(same) == spiral(i))) ++same;
    teeth.push_back({job->tooth_angles[i], same < i ? teeth[same].flute : flutes.size()});
    if (same < i) continue;
    const int tooth = static_cast<int>(i);
    flutes.push_back({sweepOf(job, tooth, wear[i], strokeOf(job, tooth, job.deepest(), wear[i]))});
  }
  return GroundCutter(ConicalCutter(job->cutter), std::move(flutes), std::move(teeth), {},
                      job->cutter.chordal_rake_depth);
}

}  // namespace

WheelProfile wheelOf(const GrindJob& job) {
  const GrindProcess& p = job.process();
  switch (p.wheel_profile) {
    case WheelShape::kStraight: return WheelProfile::straight(p.wheel_diameter, p.wheel_width, cornerRadii(p));
    case WheelShape::kFullRadius: return WheelProfile::fullRadius(p.wheel_diameter, p.wheel_width);
    case WheelShape::kPoints:
      return WheelProfile(job.process().wheel_points, cornerRadii(p)).withDiameter(p.wheel_diameter);
    case WheelShape::kAngled:
    case WheelShape::kCup: break;
  }
  const double angle = p.wheel_side == WheelFace::kUpper ? p.wheel_angle : -p.wheel_angle;
  return WheelProfile::angled(p.wheel_diameter, p.wheel_width, angle, cornerRadii(p));
}

WheelSetup setupOf(const ValidJob& job, int tooth) {
  return {job->process().setup_swivel, job->process().setup_height, job.strokeLaw(tooth).x_shift};
}

GrindStroke strokeOf(const ValidJob& job, int tooth, double depth, double wear) {
  const StrokeLaw& along = job.strokeLaw(tooth);
  const DepthLaw law = job.depthLaw(tooth, depth, wear);
  GrindStroke stroke;
  stroke.from = along.from;
  stroke.to = along.to;
  stroke.y = -law.at_end;
  stroke.y_per_x = law.taper;
  stroke.a = along.a - job->tooth_angles[static_cast<std::size_t>(tooth)];
  stroke.z_correction = job.zCorrectionOf(tooth);
  return stroke;
}

WheelSweep sweepOf(const ValidJob& job, int tooth, double wear, const GrindStroke& stroke) {
  return {ConicalCutter(job.strokeLaw(tooth).cutter), wheelOf(*job).worn(wear), job->process().wheel_diameter / 2,
          setupOf(job, tooth), stroke};
}

GroundCutter groundCutterOf(const ValidJob& job) { return groundCutterOf(job, 0, {}); }

GroundCutter groundBefore(const ValidJob& job, const PlanWatch& watch) {
  return relievedCutterOf(job, groundCutterOf(job.flutes()), job->operation - 1, watch);
}

CutterCheck checkGroundCutter(const ValidJob& job, const GroundCutter& cutter) {
  if (job.isStraight()) return checkGroundEnd(job);
  const double length = job->cutter.flute_length;
  Checker checker(job);
  std::vector<GroundSection> sections;
  bool complete = true;
  for (int i = 0; i <= kSections; ++i) {
    const GroundSection& section = sections.emplace_back(cutter.section(length * i / kSections));
    checker.check(section);
    if (i > 0) checker.checkTurn(sections[sections.size() - 2], section);
    for (const ToothSection& tooth : section.teeth) complete = complete && tooth.complete;
  }
  std::vector<GroundEdge> edges;
  for (std::size_t i = 0; i < cutter.teeth().size(); ++i) {
    edges.push_back(edgeOf(job, i, sections));
  }
  const std::optional<Range> range = complete ? Range{0, length} : cutter.completeRange(0, length);
  checker.checkOvertravel(cutter);
  checker.checkRange(range);
  return {range, checker.take(), figuresOf(job, sections), std::move(edges)};
}

CutterCheck checkGroundCutter(const ValidJob& job, const PlanWatch& watch) {
  try {
    if (job.isStraight()) return checkGroundEnd(job);
    return checkGroundCutter(job, groundCutterOf(job, kSameWear, watch));
  } catch (const ReasonError& error) {
    return {std::nullopt, {error.reason()}, {}, {}};
  } catch (const std::invalid_argument& error) {
    return {std::nullopt, {otherReason(error.what())}, {}, {}};
  }
}

}  // namespace grinder
