#pragma once

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/section_outline.h"
#include "flute_grinder/tool/tool_figure.h"

#include <QString>

#include <vector>

namespace grinder {

/// A section of the cutter that a job grinds, with the core asked for there.
struct CutterSection {
  ValidJob job;
  GroundSection ground;
  double asked_core = 0;              ///< radius of the core asked for [m]
  std::vector<PolarPoint> outline{};  ///< outline at A = 0; empty if the core is cut through

  /// Whether a figure is as asked; true also where the tooth's flute is not complete, but not where the core is cut
  /// through.
  bool isWithin(ToolFigure figure, std::size_t tooth = 0) const;
  bool hasLand(const ToothSection& tooth) const;  ///< true also where nothing is ground
};

/// Computes a section. Takes milliseconds for each tooth with a flute of its own.
/// @param job a job from withLaws(). @param x place within its flute length [m].
/// @throw std::invalid_argument if the wheel's corner radii do not fit its profile.
CutterSection cutterSection(const ValidJob& job, double x);

/// The figures of all teeth, with the figures asked for in brackets, in mm and deg. Rich text, with errors in red.
QString figuresText(const CutterSection& section);

}  // namespace grinder
