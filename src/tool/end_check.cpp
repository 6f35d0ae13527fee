#include "tool/end_check.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/log_curve.h"
#include "tool/end_cuts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

constexpr int kEndSections = 6;      ///< number of the measured distances from the axis
constexpr int kHeels = 9;            ///< number of distances at which a heel is measured, since a fin is short
constexpr int kCenterHeels = 6;      ///< number of those within the edge of a tooth to the centre
constexpr double kOutermost = 0.97;  ///< of these the farthest, per radius of the corner
constexpr double kBeyond = 20e-6;    ///< least distance of a section from where the edge begins [m]
constexpr double kTouched = 5e-6;    ///< length of a periphery's edge, and height of a heel, that do not count [m]
constexpr double kInside = 1e-6;     ///< part of the radius by which the periphery's edge is looked for within it
constexpr double kAlike = 1e-9;      ///< difference of pitch and wear between teeth that are alike [m], [rad]

/// What is measured of an end tooth, at one of its distances from the axis.
struct EndPlace {
  const CutterGeometry& cutter;
  EndSection at;
  FigureValue uncut, short_from;  ///< diameter outside which the edge is whole; of a short tooth, radius [m]
  double periphery = 0;           ///< see ToolFigure::kPeripheryTaken [m]
  std::optional<ChamferFigures> chamfer;
  FigureValue drag;  ///< of its heel [m]
  double core = 0;   ///< see ToolFigure::kGashInCore [m]
};

/// A figure of the end, with the operation from which on it is measured.
struct EndMeasurement {
  ToolFigure figure;
  OperationKind since;
  FigureValue (*measured)(const EndPlace&);
  double (*asked)(const CutterGeometry&);  ///< null of a figure that is only reported
  double (*tolerance)(const CutterGeometry&);
};

/// The primary flank, from the radius through the corner: a flute's hook takes the edge back from there.
FigureValue landFromRadius(const EndPlace& p) {
  return p.at.land ? FigureValue(*p.at.land + p.at.behind) : std::nullopt;
}

double clearanceTolerance(const CutterGeometry& c) { return c.end_clearance_tolerance; }

constexpr EndMeasurement kEndMeasurements[]{
    {ToolFigure::kEndClearance, OperationKind::kPrimaryEnd, [](const EndPlace& p) { return p.at.clearance; },
     [](const CutterGeometry& c) { return c.end_clearance; }, clearanceTolerance},
    {ToolFigure::kEndDish, OperationKind::kPrimaryEnd, [](const EndPlace& p) { return p.at.dish; },
     [](const CutterGeometry& c) { return c.end_dish; }, clearanceTolerance},
    {ToolFigure::kEndSecondClearance, OperationKind::kSecondaryEnd,
     [](const EndPlace& p) { return p.at.second_clearance; },
     [](const CutterGeometry& c) { return c.end_second_clearance; }, clearanceTolerance},
    {ToolFigure::kEndLand, OperationKind::kSecondaryEnd, landFromRadius,
     [](const CutterGeometry& c) { return c.end_land; },
     [](const CutterGeometry& c) { return widthTolerance(c.end_land); }},
    {ToolFigure::kEndRake, OperationKind::kGash, [](const EndPlace& p) { return p.at.rake; },
     [](const CutterGeometry& c) { return c.end_rake; }, [](const CutterGeometry& c) { return c.end_rake_tolerance; }},
    {ToolFigure::kUncutDiameter, OperationKind::kGash, [](const EndPlace& p) { return p.uncut; },
     [](const CutterGeometry&) { return 0.0; }, [](const CutterGeometry& c) { return c.end_uncut_diameter; }},
    {ToolFigure::kPeripheryTaken, OperationKind::kGash, [](const EndPlace& p) { return FigureValue(p.periphery); },
     [](const CutterGeometry&) { return 0.0; }, [](const CutterGeometry&) { return kTouched; }},
    {ToolFigure::kHeelDrag, OperationKind::kPrimaryEnd, [](const EndPlace& p) { return p.drag; },
     [](const CutterGeometry&) { return 0.0; }, [](const CutterGeometry&) { return kTouched; }},
    {ToolFigure::kShortFrom, OperationKind::kGash, [](const EndPlace& p) { return p.short_from; },
     [](const CutterGeometry&) { return 0.0; }, [](const CutterGeometry& c) { return c.end_short_from; }},
    {ToolFigure::kGashInCore, OperationKind::kGash, [](const EndPlace& p) { return FigureValue(p.core); }, nullptr,
     nullptr},
    {ToolFigure::kChamferWidth, OperationKind::kChamfer,
     [](const EndPlace& p) { return FigureValue(p.chamfer ? p.chamfer->width : 0); },
     [](const CutterGeometry& c) { return c.chamfer_width; },
     [](const CutterGeometry& c) { return widthTolerance(c.chamfer_width); }},
    {ToolFigure::kChamferAngle, OperationKind::kChamfer,
     [](const EndPlace& p) { return p.chamfer ? FigureValue(p.chamfer->angle) : std::nullopt; },
     [](const CutterGeometry& c) { return c.chamfer_angle; }, clearanceTolerance},
    {ToolFigure::kChamferClearance, OperationKind::kChamfer,
     [](const EndPlace& p) { return p.chamfer ? FigureValue(p.chamfer->clearance) : std::nullopt; },
     [](const CutterGeometry& c) { return c.chamfer_clearance; }, clearanceTolerance},
};

/// The job of the primary flank after a gash; nothing if there is none that can be ground yet.
std::optional<ValidJob> flankAfter(const ValidJob& job) {
  const GrindProcess* next = job->next();
  const bool follows =
      job->process().kind == OperationKind::kGash && next != nullptr && next->kind == OperationKind::kPrimaryEnd;
  if (!follows) return std::nullopt;
  try {
    return job.ofOperation(job->operation + 1);
  } catch (const InvalidJob&) {  // it is not set up yet, or cannot be ground, and says so when it is planned
    return std::nullopt;
  }
}

/// The end of a tool after all operations of the list up to a job's, and a next one if it is given.
/// @param own the job's strokes; those of the operations before are as planned.
GroundEnd groundEndOf(const ValidJob& job, const EndStrokes& own, const std::optional<ValidJob>& next) {
  EndCuts end = endCutsOf(job, own);
  if (next) addCuts(*next, plannedStrokes(*next), end.cuts);
  std::vector<double> angles = job->tooth_angles;
  for (std::size_t i = 0; i < angles.size(); ++i) angles[i] += job.edges()[i].at_end;
  return {job->cutter.end_diameter / 2, job->cutter.cut, std::move(angles),
          std::move(end.cuts),          end.blank_x,     EndFlutes(groundCutterOf(job.flutes()))};
}

/// Whether edges of end teeth are measured: they are there, or a primary flank will make them.
bool hasEdges(const ValidJob& job, const std::optional<ValidJob>& next) {
  return next || job->hasGround(OperationKind::kPrimaryEnd);
}

/// Whether there are edges, and no flank of the end is to come.
bool hasAllFlanks(const GrindJob& job) {
  return job.hasGround(OperationKind::kPrimaryEnd) &&
         std::none_of(job.operations.begin() + job.operation + 1, job.operations.end(),
                      [](const GrindProcess& p) { return isEndFlank(p.kind); });
}

/// A figure is measured once its operation is done.
bool isMeasured(const EndMeasurement& m, const ValidJob& job, const std::optional<ValidJob>& next) {
  if (m.figure == ToolFigure::kPeripheryTaken) return true;
  if (m.figure == ToolFigure::kHeelDrag) return hasAllFlanks(*job);
  if (m.figure == ToolFigure::kUncutDiameter) return hasEdges(job, next);
  if (m.figure == ToolFigure::kShortFrom) return hasEdges(job, next) && job->cutter.end_center_teeth > 0;
  return job->hasGround(m.since);
}

GroundFigure withoutValues(const EndMeasurement& m, const CutterGeometry& cutter) {
  if (m.asked == nullptr) return {m.figure, {}, {}, std::nullopt, 0};
  const double asked = m.asked(cutter);
  return {m.figure, {}, {}, Range{asked, asked}, m.tolerance(cutter)};
}

/// Measures a tooth, and keeps its figures and the faults.
class EndCheck {
 public:
  EndCheck(const ValidJob& job, const EndStrokes& strokes)
      : job_(job), next_(flankAfter(job)), end_(groundEndOf(job, strokes, next_)), cutter_(job->cutter) {}

  void measure(std::size_t tooth) {
    EndPlace place{cutter_, {}, {}, {}, periphery(tooth), {}, {}, gashInCore(tooth)};
    const double radius = cutter_.end_diameter / 2;
    const bool has_edge = hasEdges(job_, next_);
    const bool is_short = job_->isShort(static_cast<int>(tooth));
    const double whole = has_edge ? end_.wholeFrom(tooth).value_or(radius) : 0;
    (is_short ? place.short_from : place.uncut) = is_short ? whole : 2 * whole;
    if (job_->hasGround(OperationKind::kChamfer)) place.chamfer = end_.chamfer(tooth);
    const double allowed = is_short ? cutter_.end_short_from : cutter_.end_uncut_diameter / 2;
    const double inner = std::max(whole, allowed) + kBeyond;
    const double outer = kOutermost * (radius - (place.chamfer ? place.chamfer->width : 0));
    for (int i = 0; i < kEndSections && inner < outer; ++i) {
      const double r = inner + (outer - inner) * i / (kEndSections - 1);
      place.at = has_edge ? end_.section(tooth, r) : EndSection{};
      place.at.r = r;
      if (!has_edge) place.at.rake = end_.rake(tooth, r, (radius - r) * std::tan(cutter_.end_dish), 0);
      take(place, tooth);
    }
    if (!(inner < outer)) take(place, tooth);
    if (hasAllFlanks(*job_)) measureHeel(place, tooth, inner, outer);
  }

  CutterCheck result() {
    for (const EndMeasurement& m : kEndMeasurements) {
      if (!isMeasured(m, job_, next_) || find(figures_, m.figure) != nullptr) continue;
      reasons_.push_back(
          otherReason(std::string("the ") + rowOf(m.figure).words + " cannot be measured: nothing is left of it"));
    }
    return {std::nullopt, std::move(reasons_), std::move(figures_), {}};
  }

 private:
  /// Where a tooth to the centre has no edge, nothing may stand in front of where that would be.
  /// @param place of the tooth.
  void measureHeel(EndPlace place, std::size_t tooth, double inner, double outer) {
    const bool to_axis = cutter_.end_center_teeth > 0 && !job_->isShort(static_cast<int>(tooth));
    for (int i = 1; to_axis && i <= kCenterHeels; ++i) {
      EndSection at;
      at.r = inner * i / (kCenterHeels + 1);
      at.edge = (cutter_.end_diameter / 2 - at.r) * std::tan(cutter_.end_dish);
      takeHeel(place, tooth, at);
    }
    for (int i = 0; i < kHeels && inner < outer; ++i) {
      takeHeel(place, tooth, end_.edgeAt(tooth, inner + (outer - inner) * i / (kHeels - 1)));
    }
  }

  /// Takes by how much the end stands in front of an edge, up to the next tooth that has one as far in.
  void takeHeel(EndPlace& place, std::size_t tooth, const EndSection& at) {
    if (!at.edge) return;
    place.at = EndSection{};
    place.at.r = at.r;
    place.drag = end_.heelDrag(tooth, at, wayToNext(static_cast<int>(tooth), at.r));
    take(place, tooth);
  }

  /// The angle to the next tooth that has an edge at a distance from the axis [rad].
  double wayToNext(int tooth, double r) const {
    double way = 0, next_from = 0;
    do {
      const EndTooth own = endToothOf(*job_, tooth);
      way += own.pitch, next_from = own.next_from;
      tooth = job_->behind(tooth);
    } while (r < next_from);
    return way;
  }

  /// The length of the periphery's edge, behind the chamfer, that is taken away.
  double periphery(std::size_t tooth) const {
    CutterGeometry own = cutter_;
    own.spiral_angle = job_.edges()[tooth].spiral_angle;
    const ConicalCutter cutter(own);
    const LogCurve helix(cutter);
    const double behind = (cutter_.cut == CutDirection::kRightHand ? kTouched : -kTouched) / cutter.radius(0);
    const double chamfer =
        job_->hasGround(OperationKind::kChamfer) ? cutter_.chamfer_width / std::tan(cutter_.chamfer_angle) : 0;
    const double begin = chamfer + widthTolerance(chamfer), end = begin + cutter.radius(0);
    double taken = 0;
    for (double x = begin; x < end; x += kTouched) {
      if (end_.isRemovedOnEnd(tooth, cutter.radius(x) * (1 - kInside), helix.a(x) + behind, x)) taken = x - begin;
    }
    return taken;
  }

  /// How far behind the end a tooth's gash goes into the asked core.
  double gashInCore(std::size_t tooth) const {
    const auto core = [this](double x) { return askedCore(cutter_, x) / 2; };
    return end_.gashedTo(tooth, core, cutter_.flute_length);
  }

  void take(const EndPlace& place, std::size_t tooth) {
    for (const EndMeasurement& m : kEndMeasurements) {
      if (!isMeasured(m, job_, next_)) continue;
      const FigureValue value = m.measured(place);
      const bool in_core = m.figure == ToolFigure::kGashInCore;
      if (value) add(m, *value, in_core ? askedCore(cutter_, *value) / 2 : place.at.r, static_cast<int>(tooth));
    }
  }

  void add(const EndMeasurement& m, double value, double r, int tooth) {
    const GroundFigure::At at{value, r, tooth};
    const auto known = std::find_if(figures_.begin(), figures_.end(),
                                    [&](const GroundFigure& figure) { return figure.figure == m.figure; });
    if (known == figures_.end()) {
      GroundFigure& figure = figures_.emplace_back(withoutValues(m, cutter_));
      figure.least = figure.largest = at;
    } else {
      if (value < known->least.value) known->least = at;
      if (value > known->largest.value) known->largest = at;
    }
    if (m.asked == nullptr) return;
    const double asked = m.asked(cutter_), tolerance = m.tolerance(cutter_);
    const auto is_same = [&](const Reason& reason) { return reason.detail == rowOf(m.figure).words; };
    if (std::abs(value - asked) <= tolerance || std::any_of(reasons_.begin(), reasons_.end(), is_same)) return;
    Reason& reason = reasons_.emplace_back(
        Reason{ReasonKind::kEnd, 0, "", rowOf(m.figure).words, rowOf(m.figure).unit, value, tolerance, asked});
    reason.x = r;
    reason.tooth = tooth;
  }

  const ValidJob& job_;
  const std::optional<ValidJob> next_;
  const GroundEnd end_;
  const CutterGeometry& cutter_;
  std::vector<Reason> reasons_;
  CutterFigures figures_;
};

/// Whether all teeth have the pitch, the wear and the place on their flutes of the first.
bool areAlike(const ValidJob& job) {
  const std::vector<double> wear = job.wearOfTeeth();
  const double pitch = endToothOf(*job, 0).pitch;
  for (std::size_t i = 1; i < wear.size(); ++i) {
    const double off = std::max({std::abs(endToothOf(*job, static_cast<int>(i)).pitch - pitch),
                                 std::abs(wear[i] - wear[0]), std::abs(job.edges()[i].at_end - job.edges()[0].at_end)});
    if (!(off <= kAlike)) return false;
  }
  return true;
}

}  // namespace

CutterFigures askedOfEnd(const ValidJob& job) {
  const std::optional<ValidJob> next = flankAfter(job);
  CutterFigures figures;
  for (const EndMeasurement& m : kEndMeasurements) {
    if (m.asked != nullptr && isMeasured(m, job, next)) figures.push_back(withoutValues(m, job->cutter));
  }
  return figures;
}

CutterCheck checkGroundEnd(const RunStrokes& run) {
  EndCheck check(run.job(), run.straightStrokes());
  for (std::size_t tooth = 0; tooth < run.job()->tooth_angles.size(); ++tooth) check.measure(tooth);
  return check.result();
}

CutterCheck checkGroundEnd(const ValidJob& job) {
  EndCheck check(job, plannedStrokes(job));
  const auto all = job->tooth_angles.size(), center = static_cast<std::size_t>(job->cutter.end_center_teeth);
  const std::size_t teeth = !areAlike(job) ? all : center > 0 ? all / center : 1;
  for (std::size_t tooth = 0; tooth < teeth; ++tooth) check.measure(tooth);
  return check.result();
}

}  // namespace grinder
