#pragma once

#include "flute_grinder/machine/first_view.h"
#include "flute_grinder/scene/markers.h"
#include "flute_grinder/tool/wheel_profile.h"

namespace grinder {

/// The wheel in the frame `wheel` and the blank in the frame `cutter`. The first marker deletes the earlier ones.
/// @throw std::invalid_argument for a wheel that WheelProfile refuses.
visualization_msgs::MarkerArray firstViewMarkers(const FirstView& view);

/// Appends a wheel, in the frame `wheel`, whose Z is its axis.
void appendWheel(visualization_msgs::MarkerArray& array, const WheelProfile& wheel);

}  // namespace grinder
