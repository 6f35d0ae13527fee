#include "flute_grinder/geometry/tool_figure.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

constexpr double kLandPart = 0.05;       ///< of a land, by which its width may be off
constexpr double kLeastLandOff = 20e-6;  ///< that it may be off in any case [m]

const CutterGeometry& cutterOf(const FigurePlace& p) { return p.job->cutter; }

FigureValue ifComplete(const FigurePlace& p, FigureValue value) { return p.tooth().complete ? value : std::nullopt; }

/// What a secondary relief makes of the tool.
FigureValue ifSecondary(const FigurePlace& p, double asked) {
  return p.job->operation > 1 ? FigureValue(asked) : std::nullopt;
}

FigureValue ofRelief(const FigurePlace& p, FigureValue ReliefSection::*member) {
  return p.tooth().relief ? *p.tooth().relief.*member : std::nullopt;
}

}  // namespace

namespace tool_figures {

FigureValue rake(const FigurePlace& p) { return ifComplete(p, p.tooth().rake); }
FigureValue askedRake(const FigurePlace& p) { return cutterOf(p).rake_angle; }
double rakeTolerance(const FigurePlace& p) { return cutterOf(p).rake_tolerance; }

FigureValue chordalRake(const FigurePlace& p) { return ifComplete(p, p.tooth().chordal_rake); }
double chordalRakeTolerance(const FigurePlace& p) { return cutterOf(p).chordal_rake_tolerance; }

FigureValue spiral(const FigurePlace& p) { return p.tooth().spiral; }
FigureValue askedSpiral(const FigurePlace& p) { return p.job.cutterOf(static_cast<int>(p.number)).spiral_angle; }
double spiralTolerance(const FigurePlace& p) { return cutterOf(p).spiral_tolerance; }

FigureValue core(const FigurePlace& p) { return 2 * p.section.core_radius; }
FigureValue askedCore(const FigurePlace& p) { return grinder::askedCore(cutterOf(p), p.section.x); }
double coreTolerance(const FigurePlace& p) { return cutterOf(p).core_tolerance; }

FigureValue clearance(const FigurePlace& p) { return ofRelief(p, &ReliefSection::clearance); }
FigureValue askedClearance(const FigurePlace& p) { return cutterOf(p).clearance; }
double clearanceTolerance(const FigurePlace& p) { return cutterOf(p).clearance_tolerance; }

FigureValue secondClearance(const FigurePlace& p) { return ofRelief(p, &ReliefSection::second_clearance); }
FigureValue askedSecondClearance(const FigurePlace& p) { return ifSecondary(p, cutterOf(p).second_clearance); }

FigureValue primaryRelief(const FigurePlace& p) { return ofRelief(p, &ReliefSection::land); }
FigureValue askedLand(const FigurePlace& p) {
  const CutterGeometry& c = cutterOf(p);
  return ifSecondary(p, c.land * p.section.radius / (c.end_diameter / 2));  // it begins at one part of the radius
}
double landTolerance(const FigurePlace& p) { return std::max(kLandPart * askedLand(p).value_or(0), kLeastLandOff); }

}  // namespace tool_figures

bool isAsAsked(ToolFigure figure, const FigurePlace& place) {
  const ToolFigureRow& row = rowOf(figure);
  const FigureValue asked = row.asked(place), measured = row.measured(place);
  return !asked || (measured && std::abs(*measured - *asked) <= row.tolerance(place));
}

}  // namespace grinder
