#pragma once

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/end_view.h"
#include "flute_grinder/tool/section_outline.h"
#include "flute_grinder/tool/tool_figure.h"

#include <QString>

#include <optional>
#include <vector>

namespace grinder {

/// A section of the cutter that a job grinds, with the core asked for there; of an operation on the end, the end.
struct CutterSection {
  ValidJob job;
  GroundSection ground;
  double asked_core = 0;              ///< radius of the core asked for [m]
  std::vector<PolarPoint> outline{};  ///< outline at A = 0; empty if the core is cut through
  std::optional<EndView> end{};       ///< of an operation on the end, which has none of the others

  /// Whether a figure is as asked; true also where the tooth's flute is not complete, but not where the core is cut
  /// through.
  bool isWithin(ToolFigure figure, std::size_t tooth = 0) const;
  bool hasLand(const ToothSection& tooth) const;  ///< true also where nothing is ground
};

/// Computes a section. Takes milliseconds for each tooth with a flute of its own; an end takes some tenths of a second.
/// @param job a job from withLaws(). @param x place within its flute length [m].
/// @throw std::invalid_argument if the wheel's corner radii do not fit its profile, or the core under an end is cut
/// through.
CutterSection cutterSection(const ValidJob& job, double x);

/// The figures of all teeth, with the figures asked for in brackets, in mm and deg. Rich text, with errors in red.
QString figuresText(const CutterSection& section);

}  // namespace grinder
