#pragma once

#include "flute_grinder/core/units.h"
#include "flute_grinder/scene/markers.h"

#include <string>

/// @file
/// The board with text and colour scales. It stands in front of the work in the frame `table`, facing the camera of
/// rviz/grinder.rviz, so that nothing covers it and no texts overlap.
namespace flute_grinder::board {

/// Where a colour scale stands.
enum class Side { kLeft, kMiddle, kRight };

/// The board itself; needed while there is text on it.
void appendBoard(visualization_msgs::MarkerArray& array);

/// The line of text on top.
void appendLine(visualization_msgs::MarkerArray& array, const std::string& text);

/// What stands over a colour scale.
void appendTitle(visualization_msgs::MarkerArray& array, Side side, const std::string& title);

/// A colour scale from 0 to what its colours end at.
/// @param title what is measured.
/// @param end value at the scale's end, with its unit.
void appendScale(visualization_msgs::MarkerArray& array, Side side, const std::string& title, const std::string& end);

/// A length in um, to three digits.
std::string micrometres(double length);

}  // namespace flute_grinder::board
