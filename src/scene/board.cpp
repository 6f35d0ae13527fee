#include "flute_grinder/scene/board.h"

#include <cmath>
#include <cstdio>

namespace flute_grinder::board {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr const char* kFrame = "table";
constexpr double kYaw = 4.85, kPitch = 0.6;  ///< of the camera as seen from the board [rad]
constexpr double kCentreX = 0.0158, kCentreY = -0.022, kCentreZ = -0.0245;  ///< [m]
constexpr double kHalfWidth = 0.0475, kHalfHeight = 0.0095;                 ///< [m]
constexpr double kTextHeight = 2.1e-3, kFigureHeight = 1.8e-3;              ///< [m]
constexpr double kScaleLength = 0.024, kScaleWidth = 1.5e-3;                ///< [m]
constexpr int kScaleSteps = 32;

/// A place on the board: to the right, up, and toward the camera [m].
geometry_msgs::Point place(double right, double up, double out = 5e-4) {
  // Over the ground, away from the camera is -out * cos(pitch) + up * sin(pitch).
  const double away = up * std::sin(kPitch) - out * std::cos(kPitch);
  return point(kCentreX - right * std::sin(kYaw) - away * std::cos(kYaw),
               kCentreY + right * std::cos(kYaw) - away * std::sin(kYaw),
               kCentreZ + up * std::cos(kPitch) + out * std::sin(kPitch));
}

void appendText(MarkerArray& array, double right, double up, double height, const std::string& text) {
  Marker& m = append(array, "text", Marker::TEXT_VIEW_FACING, kFrame);
  m.pose.position = place(right, up);
  m.scale.z = height;
  m.text = text;
}

double centreOf(Side side) {
  constexpr double third = 2 * kHalfWidth / 3;
  return side == Side::kLeft ? -third : side == Side::kRight ? third : 0;
}

}  // namespace

void appendBoard(MarkerArray& array) {
  Marker& m = append(array, "board", Marker::TRIANGLE_LIST, kFrame);
  m.color = colour(0.05, 0.06, 0.08);
  for (const auto& [right, up] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
    m.points.push_back(place(right * kHalfWidth, up * kHalfHeight, 0));
  }
}

void appendLine(MarkerArray& array, const std::string& text) { appendText(array, 0, 6.5e-3, kTextHeight, text); }

void appendTitle(MarkerArray& array, Side side, const std::string& title) {
  appendText(array, centreOf(side), 1e-3, kFigureHeight, title);
}

void appendScale(MarkerArray& array, Side side, const std::string& title, const std::string& end) {
  const double centre = centreOf(side);
  const double from = centre - kScaleLength / 2;
  Marker& bar = append(array, "scale", Marker::LINE_LIST, kFrame);
  bar.scale.x = kScaleWidth;
  for (int i = 0; i < kScaleSteps; ++i) {
    for (const int edge : {i, i + 1}) {
      bar.points.push_back(place(from + kScaleLength * edge / kScaleSteps, -3e-3));
      bar.colors.push_back(heat((i + 0.5) / kScaleSteps));
    }
  }
  appendTitle(array, side, title);
  appendText(array, from, -6.5e-3, kFigureHeight, "0");
  appendText(array, from + kScaleLength, -6.5e-3, kFigureHeight, end);
}

std::string micrometres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g um", length / units::kMicrometre);
  return text;
}

}  // namespace flute_grinder::board
