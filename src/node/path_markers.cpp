#include "flute_grinder/node/path_markers.h"

#include "flute_grinder/core/log_curve.h"
#include "flute_grinder/core/units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flute_grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kPathTolerance = 1e-7;      ///< between the strip shown and the helix [m]
constexpr double kPathWidth = 0.25e-3;       ///< [m]
constexpr double kErrorLineWidth = 0.05e-3;  ///< [m]
constexpr double kLongestErrorLine = 3e-3;   ///< [m]
constexpr std::size_t kMostErrorPoints = 2000;
constexpr int kScaleSteps = 32;

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point p;
  p.x = x;
  p.y = y;
  p.z = z;
  return p;
}

std_msgs::ColorRGBA colour(double r, double g, double b) {
  std_msgs::ColorRGBA c;
  c.r = static_cast<float>(r);
  c.g = static_cast<float>(g);
  c.b = static_cast<float>(b);
  c.a = 1;
  return c;
}

/// From blue over green and yellow to red.
std_msgs::ColorRGBA heat(double fraction) {
  const double f = std::clamp(fraction, 0.0, 1.0);
  return colour(std::clamp(4 * f - 1.5, 0.1, 1.0), std::clamp(1.6 - std::abs(4 * f - 2), 0.1, 1.0),
                std::clamp(1.5 - 3 * f, 0.1, 1.0));
}

Marker marker(const char* ns, int id, int type, const char* frame) {
  Marker m;
  m.header.frame_id = frame;
  m.ns = ns;
  m.id = id;
  m.type = type;
  m.action = Marker::ADD;
  m.pose.orientation.w = 1;
  m.color = colour(1, 1, 1);
  m.frame_locked = true;
  return m;
}

MarkerArray startOver() {
  MarkerArray array;
  Marker m;
  m.action = Marker::DELETEALL;
  array.markers.push_back(m);
  return array;
}

/// Where the wheel touches the cutter's surface.
geometry_msgs::Point onSurface(const ConicalCutter& cutter, double x, double a) {
  const double r = cutter.radius(x);
  return point(x, r * std::cos(a), r * std::sin(a));
}

/// The largest axial distance between points of the strip that keeps within kPathTolerance of the helix: its chord
/// error is step^2 / 8 times the second derivative by X, which is tan^2 S / R inward and tan S tan C / R around.
double pathStep(const GrindProgram& program) {
  const ConicalCutter& cutter = program.cutter();
  const double radius = std::min(cutter.radius(program.strokeFrom()), cutter.radius(program.strokeTo()));
  const double turning = std::abs(cutter.tanSpiral()) * std::hypot(cutter.tanSpiral(), cutter.tanCone()) / radius;
  return std::clamp(std::sqrt(8 * kPathTolerance / std::max(turning, 1e-9)), 1e-5, 1e-3);
}

void appendStrip(MarkerArray& array, const GrindProgram& program, double tooth_angle) {
  const LogCurve curve(program.cutter());
  const double from = program.strokeFrom();
  const double to = program.strokeTo();
  const auto steps = static_cast<std::size_t>(std::ceil(std::abs(to - from) / pathStep(program)));
  for (std::size_t first = 0; first < steps; first += kMaxMarkerPoints - 1) {
    Marker m = marker("tool_path", static_cast<int>(array.markers.size()), Marker::LINE_STRIP, "cutter");
    m.scale.x = kPathWidth;
    m.color = colour(1.0, 0.6, 0.1);
    const std::size_t last = std::min(steps, first + kMaxMarkerPoints - 1);
    for (std::size_t i = first; i <= last; ++i) {
      const double x = from + (to - from) * (static_cast<double>(i) / static_cast<double>(steps));
      m.points.push_back(onSurface(program.cutter(), x, tooth_angle + curve.a(x)));
    }
    array.markers.push_back(m);
  }
}

/// The next lower of 1, 2, 5, 10, ...
double roundFactor(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  const double mantissa = value / decade;
  return (mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1) * decade;
}

/// A length from picometres up, in the unit that suits it.
std::string lengthText(double metres) {
  struct Unit {
    double size;
    const char* name;
  };
  Unit unit{1e-12, "pm"};
  for (const Unit& larger : {Unit{1e-9, "nm"}, Unit{1e-6, "um"}, Unit{1e-3, "mm"}}) {
    if (metres >= larger.size) unit = larger;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %s", metres / unit.size, unit.name);
  return text;
}

/// 1, 2 or 5 times a power of ten, as short as it can be.
std::string factorText(double factor) {
  const int exponent = static_cast<int>(std::floor(std::log10(factor) + 1e-9));
  char text[32];
  if (exponent < 4) {
    std::snprintf(text, sizeof text, "%g", factor);
  } else {
    std::snprintf(text, sizeof text, "%.0fe%d", factor / std::pow(10, exponent), exponent);
  }
  return text;
}

Marker label(int id, double x, double y, double z, const std::string& text) {
  Marker m = marker("path_error", id, Marker::TEXT_VIEW_FACING, "table");
  m.pose.position = point(x, y, z);
  m.scale.z = 2.2e-3;
  m.text = text;
  return m;
}

/// The colour scale, standing in the table's frame above the cutter.
void appendScale(MarkerArray& array, const ConicalCutter& cutter, double largest, double factor) {
  const double length = cutter.geometry().flute_length;
  const double z = cutter.radius(cutter.tanCone() < 0 ? 0 : length) + 12e-3;
  Marker bar = marker("path_error", static_cast<int>(array.markers.size()), Marker::LINE_LIST, "table");
  bar.scale.x = 1.5e-3;
  for (int i = 0; i < kScaleSteps; ++i) {
    for (const int end : {i, i + 1}) {
      bar.points.push_back(point(length * end / kScaleSteps, 0, z));
      bar.colors.push_back(heat((i + 0.5) / kScaleSteps));
    }
  }
  array.markers.push_back(bar);
  const auto add = [&](double x, double up, const std::string& text) {
    array.markers.push_back(label(static_cast<int>(array.markers.size()), x, 0, z + up, text));
  };
  add(0, -3e-3, "0");
  add(length, -3e-3, lengthText(largest));
  add(length / 2, 6e-3, "path error, drawn " + factorText(factor) + " times larger");
}

}  // namespace

MarkerArray toolPathMarkers(const GrindProgram& program) {
  MarkerArray array = startOver();
  for (const double angle : program.job().tooth_angles) appendStrip(array, program, angle);
  return array;
}

void PathErrorMarkers::add(const Setpoint& p) {
  if (p.step == StepKind::kNone) return;
  if (p.step == StepKind::kOdd) ++pairs_;
  if ((pairs_ - 1) % every_ != 0) return;
  points_.push_back({p.position[kX], p.position[kA], p.path_error});
  if (points_.size() >= kMostErrorPoints) thinOut();
}

void PathErrorMarkers::thinOut() {
  // Pairs are kept or dropped as such, so that odd and even points stay in equal number.
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < points_.size(); i += 4) {
    points_[kept++] = points_[i];
    points_[kept++] = points_[i + 1];
  }
  points_.resize(kept);
  every_ *= 2;
}

MarkerArray PathErrorMarkers::markers() const {
  MarkerArray array = startOver();
  if (points_.empty()) return array;

  const double normal_part = cutter_.cosHelixToGeneratrix();
  double largest = 0;
  for (const Point& p : points_) largest = std::max(largest, std::abs(p.error) * cutter_.radius(p.x) * normal_part);
  const double factor = largest > 0 ? roundFactor(kLongestErrorLine / largest) : 1;

  Marker lines = marker("path_error", static_cast<int>(array.markers.size()), Marker::LINE_LIST, "cutter");
  lines.scale.x = kErrorLineWidth;
  // Across the helix in the plane that touches the cone: a part along the generatrix and one around the axis.
  const double around = normal_part;
  const double along = std::copysign(std::sqrt(1 - around * around), cutter_.tanSpiral());
  const double cos_cone = 1 / std::hypot(1, cutter_.tanCone());
  const double sin_cone = cutter_.tanCone() * cos_cone;
  for (const Point& p : points_) {
    const double deviation = -p.error * cutter_.radius(p.x) * normal_part;  // of what is commanded from the theory
    const double offset = factor * deviation;
    geometry_msgs::Point end = onSurface(cutter_, p.x, p.a);
    lines.points.push_back(end);
    end.x -= offset * along * cos_cone;
    end.y += offset * (-around * std::sin(p.a) - along * sin_cone * std::cos(p.a));
    end.z += offset * (around * std::cos(p.a) - along * sin_cone * std::sin(p.a));
    lines.points.push_back(end);
    const auto c = heat(largest > 0 ? std::abs(deviation) / largest : 0);
    lines.colors.insert(lines.colors.end(), 2, c);
  }
  array.markers.push_back(lines);
  appendScale(array, cutter_, largest, factor);
  return array;
}

}  // namespace flute_grinder
