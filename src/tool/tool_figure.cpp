#include "flute_grinder/tool/tool_figure.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/curve/log_curve.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace grinder {

namespace {

using Place = FigurePlace;

constexpr double kLandPart = 0.05;       ///< tolerance of a land's width, as a fraction of it
constexpr double kLeastLandOff = 20e-6;  ///< minimum tolerance of a land's width [m]
constexpr double kMostUndercut = 3e-6;   ///< maximum undercut of an edge's radius by a relief [m]

const CutterGeometry& cutterOf(const Place& p) { return p.job->cutter; }

FigureValue ifComplete(const Place& p, FigureValue value) { return p.tooth().complete ? value : std::nullopt; }

/// A value that only a secondary relief has.
FigureValue ifSecondary(const Place& p, double asked) {
  return p.job->hasGround(OperationKind::kSecondaryRelief) ? FigureValue(asked) : std::nullopt;
}

FigureValue ofRelief(const Place& p, FigureValue ReliefSection::*member) {
  return p.tooth().relief ? *p.tooth().relief.*member : std::nullopt;
}

FigureValue notAsked(const Place&) { return std::nullopt; }
double noTolerance(const Place&) { return 0; }

void widen(Range& range, double value) { range = {std::min(range.from, value), std::max(range.to, value)}; }

/// The deviation of an edge from the asked helix, turned to the angle with the smallest deviation over the whole tooth.
FigureValue offHelix(const Place& p) {
  const LogCurve helix(ConicalCutter(p.job.cutterOf(static_cast<int>(p.number))));
  const auto off = [&](const GroundSection& section) {
    const ToothSection& tooth = section.teeth[p.number];
    return tooth.complete ? FigureValue(*tooth.edge - helix.a(section.x)) : std::nullopt;
  };
  const FigureValue here = off(p.section);
  if (!here || p.tool == nullptr || p.tool->size() < 2) return std::nullopt;
  Range all{*here, *here};
  for (const GroundSection& section : *p.tool) widen(all, off(section).value_or(*here));
  return *here - (all.from + all.to) / 2;
}

/// The land; 0 where the flutes leave none.
FigureValue land(const Place& p) {
  return p.tooth().flute ? FigureValue(p.tooth().land.value_or(0) * p.section.radius) : std::nullopt;
}

/// The asked width of the primary relief, a constant fraction of the radius.
FigureValue askedPrimary(const Place& p) {
  return ifSecondary(p, cutterOf(p).land * p.section.radius / (cutterOf(p).end_diameter / 2));
}

/// The functions that give the measured and the asked value of a figure.
struct Measurement {
  ToolFigure value;
  FigureValue (*measured)(const Place&);
  FigureValue (*asked)(const Place&);
  double (*tolerance)(const Place&);
};

constexpr Measurement kMeasurements[]{
    {ToolFigure::kRake, [](const Place& p) { return ifComplete(p, p.tooth().rake); },
     [](const Place& p) -> FigureValue { return cutterOf(p).rake_angle; },
     [](const Place& p) { return cutterOf(p).rake_tolerance; }},
    {ToolFigure::kChordalRake, [](const Place& p) { return ifComplete(p, p.tooth().chordal_rake); },
     [](const Place& p) -> FigureValue { return cutterOf(p).rake_angle; },
     [](const Place& p) { return cutterOf(p).chordal_rake_tolerance; }},
    {ToolFigure::kSpiral, [](const Place& p) { return p.tooth().spiral; },
     [](const Place& p) -> FigureValue { return p.job.cutterOf(static_cast<int>(p.number)).spiral_angle; },
     [](const Place& p) { return cutterOf(p).spiral_tolerance; }},
    {ToolFigure::kOffHelix, offHelix, notAsked, noTolerance},
    {ToolFigure::kCoreDiameter, [](const Place& p) -> FigureValue { return 2 * p.section.core_radius; },
     [](const Place& p) -> FigureValue { return askedCore(cutterOf(p), p.section.x); },
     [](const Place& p) { return cutterOf(p).core_tolerance; }},
    {ToolFigure::kLand, land, notAsked, noTolerance},
    {ToolFigure::kClearance, [](const Place& p) { return ofRelief(p, &ReliefSection::clearance); },
     [](const Place& p) -> FigureValue { return cutterOf(p).clearance; },
     [](const Place& p) { return cutterOf(p).clearance_tolerance; }},
    {ToolFigure::kSecondClearance, [](const Place& p) { return ofRelief(p, &ReliefSection::second_clearance); },
     [](const Place& p) { return ifSecondary(p, cutterOf(p).second_clearance); },
     [](const Place& p) { return cutterOf(p).clearance_tolerance; }},
    {ToolFigure::kPrimary, [](const Place& p) { return ofRelief(p, &ReliefSection::land); }, askedPrimary,
     [](const Place& p) { return widthTolerance(askedPrimary(p).value_or(0)); }},
    {ToolFigure::kEdgeDiameter,
     [](const Place& p) { return p.tooth().relief ? FigureValue(2 * p.tooth().relief->edge_radius) : std::nullopt; },
     [](const Place& p) -> FigureValue { return 2 * p.section.radius; },
     [](const Place&) { return 2 * kMostUndercut; }},
};
/// Of the figures before those of the end, which end_check.cpp measures.
static_assert(isInOrder(kMeasurements) &&
              std::size(kMeasurements) == static_cast<std::size_t>(ToolFigure::kEndClearance));

bool isOfEnd(ToolFigure figure) { return rowOf(figure).of == StrokeForm::kStraight; }
const Measurement& of(ToolFigure figure) { return kMeasurements[static_cast<std::size_t>(figure)]; }

double scaleOf(const GroundFigure& figure) { return shopScale(rowOf(figure.figure).unit); }
std::string unitOf(const GroundFigure& figure) { return std::string(" ") + shopUnit(rowOf(figure.figure).unit); }

std::string rangeText(const GroundFigure& figure, const char* digits, const Range& range) {
  const std::string low = format(digits, range.from / scaleOf(figure));
  const std::string high = format(digits, range.to / scaleOf(figure));
  return low == high ? low : low + " to " + high;
}

void add(GroundFigure& figure, double value, const Place& p) {
  const GroundFigure::At at{value, p.section.x, static_cast<int>(p.number)};
  if (value < figure.least.value) figure.least = at;
  if (value > figure.largest.value) figure.largest = at;
  const FigureValue asked = of(figure.figure).asked(p);
  if (!asked) return;
  const double tolerance = of(figure.figure).tolerance(p);
  if (!figure.asked) figure.asked = {*asked, *asked}, figure.tolerance = tolerance;
  widen(*figure.asked, *asked);
  figure.tolerance = std::min(figure.tolerance, tolerance);
}

}  // namespace

FigureValue measured(ToolFigure figure, const FigurePlace& place) {
  return isOfEnd(figure) ? std::nullopt : of(figure).measured(place);
}
FigureValue asked(ToolFigure figure, const FigurePlace& place) {
  return isOfEnd(figure) ? std::nullopt : of(figure).asked(place);
}
double widthTolerance(double width) noexcept { return std::max(kLandPart * width, kLeastLandOff); }
double tolerance(ToolFigure figure, const FigurePlace& place) { return of(figure).tolerance(place); }

bool isAsAsked(ToolFigure figure, const FigurePlace& place) {
  const FigureValue asks = asked(figure, place), has = measured(figure, place);
  return !asks || (has && std::abs(*has - *asks) <= tolerance(figure, place));
}

CutterFigures figuresOf(const ValidJob& job, const std::vector<GroundSection>& sections) {
  CutterFigures figures;
  for (const ToolFigureRow& row : kToolFigures) {
    std::optional<GroundFigure> figure;
    for (const GroundSection& section : sections) {
      for (std::size_t tooth = 0; tooth < section.teeth.size(); ++tooth) {
        const Place place{job, section, tooth, &sections};
        const FigureValue value = measured(row.value, place);
        if (!value || (row.of_complete && !place.tooth().complete)) continue;
        const GroundFigure::At at{*value, section.x, static_cast<int>(tooth)};
        if (!figure) figure = GroundFigure{row.value, at, at, std::nullopt, 0};
        add(*figure, *value, place);
      }
    }
    if (figure) figures.push_back(*figure);
  }
  return figures;
}

bool isAsAsked(const GroundFigure& figure) {
  if (!figure.asked) return true;
  return figure.least.value >= figure.asked->from - figure.tolerance &&
         figure.largest.value <= figure.asked->to + figure.tolerance;
}

const GroundFigure* find(const CutterFigures& figures, ToolFigure figure) {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const GroundFigure& one) { return one.figure == figure; });
  return found == figures.end() ? nullptr : &*found;
}

std::string groundText(const GroundFigure& figure) {
  return rangeText(figure, "%.3f", {figure.least.value, figure.largest.value}) + unitOf(figure);
}

std::string askedText(const GroundFigure& figure) { return figure.asked ? rangeText(figure, "%g", *figure.asked) : ""; }

std::string text(const GroundFigure& figure) {
  if (!figure.asked) return groundText(figure);
  const std::string unit = unitOf(figure);
  return groundText(figure) + "; asked " + askedText(figure) + unit + " within " +
         format("%g", figure.tolerance / scaleOf(figure)) + unit;
}

}  // namespace grinder
