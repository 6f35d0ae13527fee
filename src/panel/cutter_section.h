#pragma once

#include "flute_grinder/geometry/section_outline.h"
#include "flute_grinder/geometry/tool_figure.h"
#include "flute_grinder/job/valid_job.h"

#include <QString>

#include <vector>

namespace grinder {

/// A section of the cutter that a job grinds, with what is asked of it there.
struct CutterSection {
  ValidJob job;
  GroundSection ground;
  double asked_core = 0;              ///< radius [m]
  std::vector<PolarPoint> outline{};  ///< at A = 0; empty if the core is cut through

  /// Whether a figure is as asked, or the tooth's flute is not complete here. A core that is cut through is not.
  bool isWithin(ToolFigure figure, std::size_t tooth = 0) const;
  bool hasLand(const ToothSection& tooth) const;  ///< or nothing is ground here
};

/// Takes milliseconds for each tooth with a flute of its own.
/// @param job from withLaws(). @param x within its flute's length [m].
/// @throw std::invalid_argument if the wheel's corner radii do not fit its profile.
CutterSection cutterSection(const ValidJob& job, double x);

/// The figures of all teeth, in brackets what is asked, in mm and deg: rich text, with what is wrong in red.
QString figuresText(const CutterSection& section);

}  // namespace grinder
