#pragma once

#include "flute_grinder/tool/wheel_sweep.h"

#include <optional>
#include <vector>

namespace grinder {

/// A tooth in a section, as the reliefs leave it.
struct ReliefSection {
  double edge_radius = 0;           ///< radius of the edge: the blank's radius, unless a relief undercuts it [m]
  std::optional<double> clearance;  ///< radial clearance of the land at the edge, as ground [rad]
  std::optional<double> land;       ///< width of the first relief, from its start to the second or to the heel [m]
  std::optional<double> land_end_clearance;  ///< clearance of the first relief at its end [rad]
  std::optional<double> second_clearance;    ///< clearance of the second relief at its start [rad]
  /// Distance from the edge to the point where the land meets the next flute; nothing if a relief ends before it [m].
  std::optional<double> heel;
  double core_radius = 0;  ///< minimum radius that the reliefs leave, or the blank's radius if that is less [m]
  double next_edge = 0;    ///< minimum angle from the wheels to the next tooth's rake face; negative if cut [rad]
};

/// The measurements of a tooth in a section. Values that do not exist there, e.g. of a land that is ground away, are
/// empty.
struct ToothSection {
  std::optional<double> edge;         ///< angle of the cutting edge on the blank's circle, in the sense of A [rad]
  double edge_wheel_x = 0;            ///< X of the wheel's centre while it forms that edge [m]
  std::optional<double> rake;         ///< radial rake at the edge, as reliefs leave it [rad]
  std::optional<double> normal_rake;  ///< rake normal to the edge [rad]
  /// Radial angle of the chord from the edge to the rake face at CutterGeometry::chordal_rake_depth, as a measuring
  /// machine finds it. The rake itself is the tangent at the edge, and may belong to a narrow facet [rad].
  std::optional<double> chordal_rake;
  std::optional<double> flute;   ///< angle that the flute takes at the outer circle [rad]
  std::optional<double> land;    ///< angle between this flute and the next one behind its edge [rad]
  double least_land = 0;         ///< minimum angle of the land from the core outward; 0 or less: no land is left [rad]
  std::optional<double> spiral;  ///< spiral angle of the ground edge [rad]
  double depth = 0;              ///< depth of the flute below the outer circle [m]
  bool complete = false;         ///< whether it is complete over its depth: a longer stroke would remove nothing more
  std::optional<ReliefSection> relief;  ///< reliefs of a tooth that has an edge
};

/// Depth below the edge of the end of a rake face's chord [m].
/// @param asked as CutterGeometry::chordal_rake_depth [m].
/// @param flute_depth depth of the flute [m].
double chordDepth(double asked, double flute_depth) noexcept;

/// The radial angle of a chord of a right-hand rake face.
/// @param outer,inner radii of its ends [m].
/// @param turn angle from the outer end to the inner end [rad].
double chordAngle(double outer, double inner, double turn) noexcept;

/// The spiral angle of a helix with the same turn between two sections: the mean of the edge's spiral angles there.
/// @param from,to X of the sections, not equal [m].
/// @param turn angle of the turn [rad].
double meanSpiral(const ConicalCutter& cutter, double from, double to, double turn) noexcept;

constexpr double kMinCore = 1e-6;  ///< minimum radius of a core that still holds the teeth together [m]

/// A section of the ground cutter, normal to its axis.
struct GroundSection {
  double x = 0;            ///< [m]
  double radius = 0;       ///< radius of the blank [m]
  double core_radius = 0;  ///< minimum radius left by flutes and reliefs; the blank's where nothing is removed [m]
  std::vector<ToothSection> teeth;
};

/// The strokes of the wheel that grind a flute.
using Flute = std::vector<WheelSweep>;

/// The strokes of the wheel that grind a relief of a tooth.
using Relief = std::vector<WheelSweep>;

/// The reliefs of a tooth, in the order of grinding.
using Reliefs = std::vector<Relief>;

/// The wall that several strokes leave together on a circle: the farthest of the walls that reach it.
/// @param x,r X and radius of the circle [m].
/// @param high whether it is the end of the arc at the larger angle.
std::optional<Wall> outermostWall(const std::vector<WheelSweep>& strokes, double x, double r, bool high);

/// The minimum radius that strokes leave in a section [m].
/// @param radius radius of the blank there [m].
double leastRadius(const std::vector<WheelSweep>& strokes, double x, double radius);

/// The angle and the flute of a tooth.
struct GroundTooth {
  double angle = 0;       ///< angle added to A of the flute's strokes [rad]
  std::size_t flute = 0;  ///< index of the flute
};

/// The cutter that a job's strokes leave, measured in sections. Teeth that share a flute are measured once.
class GroundCutter {
 public:
  /// @param flutes the distinct flutes, for a tooth at angle 0.
  /// @param teeth teeth in ascending angles within one turn.
  /// @param reliefs the reliefs behind each flute's edge, for a tooth at angle 0; empty if there are none.
  /// @param chordal_rake_depth as in CutterGeometry [m].
  /// @throw std::invalid_argument if a flute has no strokes, a tooth's flute does not exist, or only some have reliefs.
  GroundCutter(const ConicalCutter& cutter, std::vector<Flute> flutes, std::vector<GroundTooth> teeth,
               std::vector<Reliefs> reliefs = {}, double chordal_rake_depth = 0);

  /// @param x X of the section, where the blank's radius is positive [m].
  GroundSection section(double x) const;

  /// A tooth at angle 0 in a section, as its flute alone leaves it: without a land, reliefs, or whether it is complete.
  ToothSection tooth(std::size_t flute, double x) const;

  /// The area removed in a section [m^2].
  double areaRemoved(const GroundSection& section) const { return areaRemoved(section.x, section.core_radius); }
  /// The area that one more stroke would remove in a section [m^2].
  /// @param angle angle of the stroke's tooth [rad].
  double areaRemovedBy(const WheelSweep& stroke, double angle, double x) const;

  /// The range in which all flutes are complete, to 10 um.
  /// @param from,to range to examine [m].
  /// @return the longest such range around the middle; nothing if a flute is not complete there.
  std::optional<Range> completeRange(double from, double to) const;

  /// The volume removed between two sections, from the areas of some sections in between [m^3].
  double volumeRemoved(double from, double to, int sections) const;

  /// The arc of the circle of radius `r` at `x` that a flute of a tooth at angle 0 removes.
  std::optional<Arc> arc(const Flute& flute, double x, double r) const;

  const ConicalCutter& cutter() const noexcept { return cutter_; }
  double chordalRakeDepth() const noexcept { return chordal_rake_depth_; }  ///< as in CutterGeometry [m]
  CutDirection direction() const noexcept { return cutter_.cone().cut; }
  const std::vector<Flute>& flutes() const noexcept { return flutes_; }
  const std::vector<GroundTooth>& teeth() const noexcept { return teeth_; }
  /// The reliefs of a tooth, as if it were at angle 0.
  const Reliefs& reliefs(std::size_t tooth) const;

  /// The tooth whose flute bounds a tooth's land, and its distance.
  struct NextTooth {
    std::size_t tooth;
    double pitch;  ///< angle to that tooth [rad]
  };
  NextTooth next(std::size_t tooth) const;
  /// Whether the lands of two teeth are bounded by the same flutes at the same distance.
  bool landsAreAlike(std::size_t a, std::size_t b) const;

 private:
  /// Arcs of a flute on circles from the core outward; nothing where the flute is not that deep.
  using Arcs = std::vector<std::optional<Arc>>;

  std::optional<Wall> rakeFace(const Flute& flute, double x, double r) const {
    return outermostWall(flute, x, r, direction() == CutDirection::kRightHand);
  }
  /// Measures the rakes of a tooth at its edge, on the circle of radius `r`.
  void measureRake(const Flute& flute, double x, double r, const Wall& edge, ToothSection& section) const;
  double coreRadius(const Flute& flute, double x) const { return leastRadius(flute, x, cutter_.radius(x)); }
  double coreRadius(double x) const;
  double areaRemoved(double x, double core_radius) const;
  /// The arcs of a circle that flutes and reliefs of all teeth remove.
  std::vector<Arc> arcsOn(double x, double r) const;
  bool isComplete(const Flute& flute, double x, double core_radius) const;
  bool arcIsComplete(const Flute& flute, double x, double r) const;
  bool isComplete(double x) const;
  void measureLand(std::size_t tooth, const std::vector<ToothSection>& measured, const std::vector<Arcs>& arcs,
                   ToothSection& section) const;

  ConicalCutter cutter_;
  std::vector<Flute> flutes_;
  std::vector<GroundTooth> teeth_;
  std::vector<Reliefs> reliefs_;
  double chordal_rake_depth_;
};

}  // namespace grinder
