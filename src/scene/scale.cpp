#include "scene/scale.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/conical_cutter.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kLetters = 0.07;     ///< height of letters, as a fraction of the flutes' length
constexpr double kLineWidth = 0.006;  ///< width of the scale's lines, as a fraction of the same
constexpr double kLineSpacing = 2;    ///< heights of letters
constexpr double kRounding = 1e-6;    ///< steps
constexpr const char* kWork = "work";

/// Appends a text of the frame `work`, in front of the tool.
void appendText(MarkerArray& array, const std::string& text, double x, double in_front, double height) {
  Marker& m = append(array, "shown", Marker::TEXT_VIEW_FACING, kWork);
  m.pose.position = point(x, -in_front, 0);
  m.scale.z = height;
  m.text = text;
}

/// A step of a scale: 1, 2 or 5 times a power of ten, three to seven of it in a length [m].
double stepOf(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  double step = power;
  for (const double smaller : {0.5, 0.2}) {
    if (length / step < 3) step = smaller * power;
  }
  return length / step < 8 ? step : 2 * power;
}

}  // namespace

void appendScale(MarkerArray& array, const CutterGeometry& cutter, const std::string& shown) {
  const double length = cutter.flute_length, letters = kLetters * length;
  const double at = ConicalCutter(cutter).radius(length) + letters;
  const double step = stepOf(length);
  Marker& m = appendLines(array, "shown", Marker::LINE_LIST, kWork, kLineWidth * length);
  const auto line = [&](double x, double y, double to_x, double to_y) {
    m.points.insert(m.points.end(), {point(x, -y, 0), point(to_x, -to_y, 0)});
  };
  line(0, at, length, at);
  line(length, at, length, at + letters / 2);
  const auto steps = static_cast<int>(length / step + kRounding);
  for (int i = 0; i <= steps; ++i) line(i * step, at, i * step, at + letters / 2);
  for (int i = 0; i <= steps; ++i) {
    const std::string number = format("%g", i * step / units::kMillimetre);
    appendText(array, i < steps ? number : number + " mm", i * step, at + letters, letters);
  }
  double below = at + 5 * letters;
  const auto below_it = [&](const std::string& text) {
    appendText(array, text, length / 2, below += kLineSpacing * letters, letters);
  };
  const std::size_t tool = std::min(shown.rfind(" ("), shown.size());
  below_it(shown.substr(0, tool));
  below_it(format("flutes %g mm long", length / units::kMillimetre) + shown.substr(tool));
}

}  // namespace grinder
