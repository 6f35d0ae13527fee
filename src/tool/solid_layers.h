#pragma once

#include "flute_grinder/tool/cutter_solid.h"
#include "flute_grinder/tool/ground_cutter.h"
#include "flute_grinder/tool/section_outline.h"

#include <vector>

namespace grinder {

/// The outline of a solid at an X [m].
struct SolidLayer {
  double x;
  std::vector<PolarPoint> outline;
};

/// The outlines of cone and shank through which a solid goes, by ascending X. Sections of a planned tool are computed
/// where those beside them do not foretell them within 1e-4 of the radius, of a recorded one everywhere; between them
/// are as many as the twist needs. Two at the same X are a step.
/// @throw std::invalid_argument like sectionOutline().
std::vector<SolidLayer> solidLayers(const GroundCutter& cutter, const SolidExtent& extent,
                                    const SolidResolution& resolution, const OutlineGrid& grid);

}  // namespace grinder
