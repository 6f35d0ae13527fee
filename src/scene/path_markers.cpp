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
constexpr std::size_t kEndSteps = 200;      ///< number of steps of a strip on the end
constexpr double kOnLine = 1e-6;            ///< part of a line on the end by which its ends are beyond it
constexpr double kMinAspect = 4;            ///< least length of a line on the end, per width
constexpr std::size_t kMaxArrows = 200;
constexpr std::size_t kMaxExecutedPoints = 2000;
static_assert(std::max({kMostSteps, kEndSteps, kMaxExecutedPoints}) < kMaxMarkerPoints);

/// A point of the cutter at the radius r.
geometry_msgs::Point atRadius(double x, double r, double a) { return point(x, r * std::cos(a), r * std::sin(a)); }

/// A place of the frame `work` on the cutter.
geometry_msgs::Point onCutter(const Eigen::Vector3d& at, double a) {
  return atRadius(at[0], std::hypot(at[1], at[2]), std::atan2(at[2], at[1]) + a);
}

/// Whether a point can be shown.
bool isNear(const geometry_msgs::Point& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// Scale of line widths: thinner on a small cutter, so that they do not cover it.
double fineness(const ConicalCutter& cutter) { return std::min(1.0, cutter.radius(0) / 2.5e-3); }

/// The same of a job; a chamfer's line is short.
double fineness(const ValidJob& job) {
  double scale = fineness(ConicalCutter(job->cutter));
  for (const EndLine& line : deepestLines(job)) {
    scale = std::min(scale, (line.at(1) - line.at(0)).norm() / (kMinAspect * kPathWidth));
  }
  return scale;
}

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

std::optional<EndPasses> straightOf(const ValidJob& job) {
  return job.isStraight() ? std::optional<EndPasses>(job) : std::nullopt;
}

/// Number of steps between the points of a strip.
std::size_t stepsOf(const GrindProgram& program) {
  if (program.isStraight()) return kEndSteps;
  return std::min(kMostSteps,
                  static_cast<std::size_t>(std::ceil(program.job()->cutter.flute_length / pathStep(program))));
}

double xOf(const GroundEdge& edge, double part) { return edge.from() + (edge.to() - edge.from()) * part; }

/// Whether a place is on an edge; beyond the edge's ends the overtravel forms none.
bool isOn(const GroundEdge& edge, double x) { return x >= edge.from() && x <= edge.to(); }

/// Rounds down to 1, 2, 5, 10, ...
double roundDown(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  const double mantissa = value / decade;
  return (mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1) * decade;
}

}  // namespace

std::optional<EndLine::Place> EndPasses::placeOf(const Setpoint& setpoint, const Axes& actual) {
  const ToothPass pass{setpoint.tooth, setpoint.pass};
  if (!(pass_ == pass)) {
    const auto is_this = [&](const JobPass& other) { return other.place == pass; };
    const auto found = std::find_if(job_.passes().begin(), job_.passes().end(), is_this);
    if (found == job_.passes().end()) return std::nullopt;
    line_.emplace(job_, pass.tooth, found->depth, found->wear);
    pass_ = pass;
  }
  const std::optional<EndLine::Place> place = line_->placeOf(actual);
  return place && place->part >= -kOnLine && place->part <= 1 + kOnLine ? place : std::nullopt;
}

ToolPath::ToolPath(const GrindProgram& program, const std::vector<GroundEdge>& edges)
    : formed_(formedEdgeOf(program.job())),
      straight_(straightOf(program.job())),
      tolerance_(program.job()->interpolation.tolerance),
      fineness_(fineness(program.job())),
      steps_(stepsOf(program)),
      measured_(steps_ + 1, -1) {
  const ValidJob& job = program.job();
  for (EndLine& line : deepestLines(job)) flutes_.push_back({std::move(line), {}});
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int tooth = static_cast<int>(i);
    flutes_.push_back({Edge{job.strokeLaw(tooth).a, program.helix(tooth).curve, edges[i]}, {}});
  }
}

bool ToolPath::isShown(const Flute& flute) {
  const Edge* edge = std::get_if<Edge>(&flute.line);
  return edge == nullptr || !edge->edge.empty();
}

geometry_msgs::Point ToolPath::pointOf(const Flute& flute, std::size_t i) const {
  const double part = static_cast<double>(i) / static_cast<double>(steps_);
  if (const EndLine* line = std::get_if<EndLine>(&flute.line)) return onCutter(line->at(part), line->a());
  const auto& [angle, curve, edge] = std::get<Edge>(flute.line);
  const GroundEdge::Place at = edge.at(xOf(edge, part));
  return atRadius(at.x, formed_.cutter.radius(at.x), angle + curve.a(at.wheel_x) + at.turn);
}

bool ToolPath::add(const Setpoint& p, const Axes& actual) {
  // The last setpoints of a straight stroke may all be at its end, but for rounding.
  if (p.move == MoveKind::kStroke && p.move_fraction == 1 && !active_) return false;
  const std::optional<std::size_t> before = active_;
  const PassPhase phase = phaseOf(p.move);
  if (phase == PassPhase::kBefore || phase == PassPhase::kStroke) active_ = p.tooth;
  if (p.move != MoveKind::kStroke) return active_ != before;
  if (straight_ || p.step != StepKind::kNone) measure(p, actual);
  if (p.move_fraction < 1) return active_ != before;
  finishPass(flutes_[p.tooth]);
  deactivate();
  return true;
}

std::optional<ToolPath::Measured> ToolPath::measured(const Setpoint& p, const Axes& actual) {
  if (straight_) {
    const std::optional<EndLine::Place> place = straight_->placeOf(p, actual);
    return place ? std::optional(Measured{std::clamp(place->part, 0.0, 1.0), place->error}) : std::nullopt;
  }
  const auto& [angle, curve, edge] = std::get<Edge>(flutes_[p.tooth].line);
  Measured measured{{}, formed_.deviation(actual[kX], std::abs(angle + curve.a(actual[kX]) - actual[kA]))};
  if (edge.empty()) return measured;
  const double x = edge.formedAt(actual[kX]).x;
  if (isOn(edge, x)) measured.part = (x - edge.from()) / (edge.to() - edge.from());
  return measured;
}

void ToolPath::measure(const Setpoint& p, const Axes& actual) {
  const std::optional<Measured> now = measured(p, actual);
  // A faulty drive may report NaN, or a position beyond the cone's apex.
  if (!now || !(now->error <= kFarthest)) return;
  max_ = std::max(max_, now->error);
  if (!now->part) return;
  float& max = measured_[static_cast<std::size_t>(std::lround(*now->part * static_cast<double>(steps_)))];
  max = std::max(max, static_cast<float>(now->error));
}

void ToolPath::finishPass(Flute& flute) {
  // At more than one point per cycle, a skipped point gets the measurement next to it.
  for (std::size_t i = 1; i <= steps_; ++i) {
    if (measured_[i] < 0) measured_[i] = measured_[i - 1];
  }
  for (std::size_t i = steps_; i-- > 0;) {
    if (measured_[i] < 0) measured_[i] = measured_[i + 1];
  }
  if (measured_.front() >= 0) flute.errors = measured_;
}

void ToolPath::deactivate() {
  active_.reset();
  std::fill(measured_.begin(), measured_.end(), -1);
}

void ToolPath::appendFlute(MarkerArray& array, std::size_t tooth) const {
  const Flute& flute = flutes_[tooth];
  if (!isShown(flute)) return;
  const bool active = active_ == tooth;
  Marker& m = appendLines(array, "tool_path", Marker::LINE_STRIP, kFrame, kPathWidth * fineness_);
  m.color = active ? colour(1, 0.2, 0.9) : colour(0.72, 0.72, 0.72);
  for (std::size_t i = 0; i <= steps_; ++i) {
    m.points.push_back(pointOf(flute, i));
    if (!active && !flute.errors.empty()) m.colors.push_back(errorColour(flute.errors[i] / tolerance_));
  }
}

MarkerArray ToolPath::markers() const {
  MarkerArray array = clearedArray();
  for (std::size_t tooth = 0; tooth < flutes_.size(); ++tooth) appendFlute(array, tooth);
  return array;
}

ExecutedPath::ExecutedPath(const GrindProgram& program, std::vector<GroundEdge> edges)
    : cutter_(program.job()->cutter),
      fineness_(fineness(program.job())),
      straight_(straightOf(program.job())),
      edges_(std::move(edges)) {
  for (const Move& move : program.moves()) wear_of_move_.push_back(move.wear);
}

std::optional<geometry_msgs::Point> ExecutedPath::placeOf(const Setpoint& p, const Axes& actual) {
  if (straight_) {
    const std::optional<EndLine::Place> place = straight_->placeOf(p, actual);
    return place ? std::optional(onCutter(place->at, actual[kA])) : std::nullopt;
  }
  if (edges_[p.tooth].empty()) return std::nullopt;
  const GroundEdge::Place place = edges_[p.tooth].formedAt(actual[kX]);
  const double height = actual[kY] + wear_of_move_[p.move_index] - actual[kX] * cutter_.tanCone();
  return atRadius(place.x, cutter_.radius(place.x) + height, actual[kA] + place.turn);
}

void ExecutedPath::add(const Setpoint& p, const Axes& actual) {
  if (p.move != MoveKind::kStroke) return;
  if (move_ != p.move_index) {
    move_ = p.move_index;
    points_.clear();
    taken_ = 0;
    every_ = 1;
  }
  const std::optional<geometry_msgs::Point> at = placeOf(p, actual);
  if (!at || !isNear(*at)) return;
  last_ = *at;
  if (taken_++ % every_ != 0) return;
  points_.push_back(last_);
  if (points_.size() < kMaxExecutedPoints) return;
  for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
  points_.resize(points_.size() / 2);
  every_ *= 2;
}

void ExecutedPath::append(MarkerArray& array) const {
  if (points_.empty()) return;
  Marker& m = appendLines(array, "executed_path", Marker::LINE_STRIP, kFrame, kExecutedWidth * fineness_);
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
    arrows.colors.insert(arrows.colors.end(), 2, errorColour(std::abs(p.deviation) / tolerance_));
  }
  return array;
}

}  // namespace grinder
