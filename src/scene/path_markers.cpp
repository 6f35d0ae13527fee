#include "flute_grinder/scene/path_markers.h"

#include "flute_grinder/job/grind_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr const char* kFrame = "cutter";
constexpr double kPathTolerance = 1e-7;     ///< maximum distance between the strip shown and the helix [m]
constexpr double kPathWidth = 0.3e-3;       ///< width for a large cutter, like the other widths [m]
constexpr double kExecutedWidth = 0.25e-3;  ///< [m]
constexpr double kArrowWidth = 0.12e-3;     ///< [m]
constexpr double kMaxArrow = 3e-3;          ///< [m]
constexpr double kMinDrawn = 1e-3;          ///< minimum error for an arrow of full length, per tolerance
constexpr double kFarthest = 1;             ///< points beyond, and NaN, are not shown [m]
constexpr std::size_t kMostSteps = 4000;    ///< maximum number of steps of a flute's strip
constexpr std::size_t kMaxArrows = 200;
constexpr std::size_t kMaxExecutedPoints = 2000;

/// A point of the cutter at the radius r.
geometry_msgs::Point atRadius(double x, double r, double a) { return point(x, r * std::cos(a), r * std::sin(a)); }

/// Whether a point can be shown.
bool isNear(const geometry_msgs::Point& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// Scale of line widths: thinner on a small cutter, so that they do not cover it.
double fineness(const ConicalCutter& cutter) { return std::min(1.0, cutter.radius(0) / 2.5e-3); }

/// The maximum axial distance between points of a strip that stays within kPathTolerance of the helix: the chord
/// error is step^2 / 8 times the second derivative by X, which is tan^2 S / R inward and tan S tan C / R around.
double pathStep(const GrindProgram& program) {
  double turning = 0;  // turning of the steepest helix
  for (const Helix& helix : program.helices()) {
    const ConicalCutter& cutter = helix.edge.cutter;
    const double radius = std::min(cutter.radius(0), cutter.radius(cutter.cone().flute_length));
    turning =
        std::max(turning, std::abs(cutter.tanSpiral()) * std::hypot(cutter.tanSpiral(), cutter.tanCone()) / radius);
  }
  return std::clamp(std::sqrt(8 * kPathTolerance / std::max(turning, 1e-9)), 1e-5, 1e-3);
}

/// The edge that the strokes of all teeth form, by its cone; of straight strokes the cutter's.
FormedEdge formedEdgeOf(const ValidJob& job) {
  if (job.isStraight()) return {ConicalCutter(job->cutter), 0};
  return {ConicalCutter(job.strokeLaw(0).cutter), job.strokeLaw(0).x_shift};
}

/// Whether a place is on an edge; beyond the edge's ends the overtravel forms none.
bool isOn(const GroundEdge& edge, double x) { return x >= edge.from() && x <= edge.to(); }

/// Rounds down to 1, 2, 5, 10, ...
double roundDown(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  const double mantissa = value / decade;
  return (mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1) * decade;
}

}  // namespace

ToolPath::ToolPath(const GrindProgram& program, const std::vector<GroundEdge>& edges)
    : formed_(formedEdgeOf(program.job())),
      tolerance_(program.job()->interpolation.tolerance),
      steps_(std::min(kMostSteps,
                      static_cast<std::size_t>(std::ceil(program.job()->cutter.flute_length / pathStep(program))))),
      measured_(steps_ + 1, -1) {
  for (std::size_t i = 0; i < edges.size() && !program.isStraight(); ++i) {
    const int tooth = static_cast<int>(i);
    flutes_.push_back({program.job().strokeLaw(tooth).a, program.helix(tooth).curve, edges[i], {}});
  }
}

double ToolPath::x(const GroundEdge& edge, std::size_t i) const {
  return edge.from() + (edge.to() - edge.from()) * (static_cast<double>(i) / static_cast<double>(steps_));
}

bool ToolPath::add(const Setpoint& p, const Axes& actual) {
  if (flutes_.empty()) return false;
  const std::optional<std::size_t> before = active_;
  const PassPhase phase = phaseOf(p.move);
  if (phase == PassPhase::kBefore || phase == PassPhase::kStroke) active_ = p.tooth;
  if (p.move != MoveKind::kStroke) return active_ != before;
  if (p.step != StepKind::kNone) measure(p, actual);
  if (p.move_fraction < 1) return active_ != before;
  finishPass(flutes_[p.tooth]);
  deactivate();
  return true;
}

void ToolPath::measure(const Setpoint& p, const Axes& actual) {
  const Flute& flute = flutes_[p.tooth];
  const double error = formed_.deviation(actual[kX], std::abs(flute.angle + flute.curve.a(actual[kX]) - actual[kA]));
  // A faulty drive may report NaN, or a position beyond the cone's apex.
  if (!(error <= kFarthest)) return;
  max_ = std::max(max_, error);
  if (flute.edge.empty()) return;
  const double x = flute.edge.formedAt(actual[kX]).x;
  if (!isOn(flute.edge, x)) return;
  const double at = (x - flute.edge.from()) / (flute.edge.to() - flute.edge.from()) * static_cast<double>(steps_);
  float& max = measured_[static_cast<std::size_t>(std::lround(at))];
  max = std::max(max, static_cast<float>(error));
}

void ToolPath::finishPass(Flute& flute) {
  // At more than one point per cycle, a skipped point gets the measurement next to it.
  for (std::size_t i = 1; i <= steps_; ++i) {
    if (measured_[i] < 0) measured_[i] = measured_[i - 1];
  }
  for (std::size_t i = steps_; i-- > 0;) {
    if (measured_[i] < 0) measured_[i] = measured_[i + 1];
  }
  flute.errors = measured_;
}

void ToolPath::deactivate() {
  active_.reset();
  std::fill(measured_.begin(), measured_.end(), -1);
}

void ToolPath::appendFlute(MarkerArray& array, std::size_t tooth) const {
  const Flute& flute = flutes_[tooth];
  if (flute.edge.empty()) return;
  const bool active = active_ == tooth;
  for (std::size_t first = 0; first < steps_; first += kMaxMarkerPoints - 1) {
    Marker& m = appendLines(array, "tool_path", Marker::LINE_STRIP, kFrame, kPathWidth * fineness(formed_.cutter));
    m.color = active ? colour(1, 0.2, 0.9) : colour(0.72, 0.72, 0.72);
    const std::size_t last = std::min(steps_, first + kMaxMarkerPoints - 1);
    for (std::size_t i = first; i <= last; ++i) {
      const GroundEdge::Place at = flute.edge.at(x(flute.edge, i));
      m.points.push_back(
          atRadius(at.x, formed_.cutter.radius(at.x), flute.angle + flute.curve.a(at.wheel_x) + at.turn));
      if (!active && !flute.errors.empty()) m.colors.push_back(heat(flute.errors[i] / tolerance_));
    }
  }
}

MarkerArray ToolPath::markers() const {
  MarkerArray array = clearedArray();
  for (std::size_t tooth = 0; tooth < flutes_.size(); ++tooth) appendFlute(array, tooth);
  return array;
}

ExecutedPath::ExecutedPath(const GrindProgram& program, std::vector<GroundEdge> edges)
    : cutter_(program.job()->cutter), edges_(std::move(edges)) {
  for (const Move& move : program.moves()) wear_of_move_.push_back(move.wear);
}

void ExecutedPath::add(const Setpoint& p, const Axes& actual) {
  if (p.move != MoveKind::kStroke || edges_.empty() || edges_[p.tooth].empty()) return;
  if (move_ != p.move_index) {
    move_ = p.move_index;
    points_.clear();
    taken_ = 0;
    every_ = 1;
  }
  const GroundEdge::Place place = edges_[p.tooth].formedAt(actual[kX]);
  const double height = actual[kY] + wear_of_move_[p.move_index] - actual[kX] * cutter_.tanCone();
  const geometry_msgs::Point at = atRadius(place.x, cutter_.radius(place.x) + height, actual[kA] + place.turn);
  if (!isNear(at)) return;
  last_ = at;
  if (taken_++ % every_ != 0) return;
  points_.push_back(last_);
  if (points_.size() < kMaxExecutedPoints) return;
  for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
  points_.resize(points_.size() / 2);
  every_ *= 2;
}

void ExecutedPath::append(MarkerArray& array) const {
  if (points_.empty()) return;
  Marker& m = appendLines(array, "executed_path", Marker::LINE_STRIP, kFrame, kExecutedWidth * fineness(cutter_));
  m.color = colour(0.3, 1, 1);
  m.points = points_;
  m.points.push_back(last_);
}

PathErrorMarkers::PathErrorMarkers(const ValidJob& job, std::vector<GroundEdge> edges)
    : formed_(formedEdgeOf(job)), edges_(std::move(edges)), tolerance_(job->interpolation.tolerance) {}

void PathErrorMarkers::add(const Setpoint& p) {
  if (p.step == StepKind::kNone || edges_[p.tooth].empty()) return;
  const double deviation = formed_.deviation(p.position[kX], -p.path_error);
  if (!(std::abs(deviation) <= kFarthest && p.position.isFinite().all())) return;
  const GroundEdge::Place place = edges_[p.tooth].formedAt(p.position[kX]);
  if (!isOn(edges_[p.tooth], place.x)) return;
  if (move_ != p.move_index) {
    move_ = p.move_index;
    points_.clear();
    max_ = 0;
    pairs_ = 0;
    every_ = 1;
  }
  if (p.step == StepKind::kOdd) ++pairs_;
  max_ = std::max(max_, std::abs(deviation));
  if ((pairs_ - 1) % every_ != 0) return;
  points_.push_back({place.x, p.position[kA] + place.turn, deviation});
  if (points_.size() >= kMaxArrows && p.step == StepKind::kEven) thinOut();
}

void PathErrorMarkers::thinOut() {
  // Keep or drop whole pairs, so that odd and even points remain equal in number.
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < points_.size(); i += 4) {
    points_[kept++] = points_[i];
    points_[kept++] = points_[i + 1];
  }
  points_.resize(kept);
  every_ *= 2;
}

double PathErrorMarkers::scale() const {
  if (points_.empty()) return 0;
  // On a cylinder, for example, there are only rounding errors; they must not look like real ones.
  const double max = std::max(max_, kMinDrawn * tolerance_);
  return roundDown(kMaxArrow * fineness(formed_.cutter) / max);
}

MarkerArray PathErrorMarkers::markers() const {
  MarkerArray array = clearedArray();
  if (points_.empty()) return array;
  Marker& arrows = appendLines(array, "path_error", Marker::LINE_LIST, kFrame, kArrowWidth * fineness(formed_.cutter));
  // The direction across the helix, tangent to the cone: a part along the generatrix and one around the axis.
  const ConicalCutter& cutter = formed_.cutter;
  const double around = cutter.cosHelixToGeneratrix();
  const double along = std::copysign(std::sqrt(1 - around * around), cutter.tanSpiral());
  const double cos_cone = 1 / std::hypot(1, cutter.tanCone());
  const double sin_cone = cutter.tanCone() * cos_cone;
  const double factor = scale();
  for (const Point& p : points_) {
    const double offset = factor * p.deviation;
    const geometry_msgs::Point from = atRadius(p.x, cutter.radius(p.x), p.a);
    geometry_msgs::Point to = from;
    to.x -= offset * along * cos_cone;
    to.y += offset * (-around * std::sin(p.a) - along * sin_cone * std::cos(p.a));
    to.z += offset * (around * std::cos(p.a) - along * sin_cone * std::sin(p.a));
    arrows.points.insert(arrows.points.end(), {from, to});
    arrows.colors.insert(arrows.colors.end(), 2, heat(std::abs(p.deviation) / tolerance_));
  }
  return array;
}

}  // namespace grinder
