#pragma once

#include "flute_grinder/geometry/wheel_sweep.h"

#include <optional>
#include <vector>

namespace grinder {

/// What reliefs leave of a tooth in a section.
struct ReliefSection {
  double edge_radius = 0;           ///< what is left at the edge: the blank's, unless a relief undercuts it [m]
  std::optional<double> clearance;  ///< of the land where it begins, at the edge as it is left, radial [rad]
  std::optional<double> land;       ///< width of the first relief, from its start up to the second or to the heel [m]
  std::optional<double> land_end_clearance;  ///< of the first relief there [rad]
  std::optional<double> second_clearance;    ///< of the second relief where it begins [rad]
  /// From the edge to where the land meets the next flute; nothing if a relief ends before [m].
  std::optional<double> heel;
  double core_radius = 0;  ///< least that the reliefs leave, the blank's if that is less [m]
  double next_edge = 0;    ///< minimum distance of the wheels from the next tooth's rake face; negative if cut [rad]
};

/// What is measured of a tooth in a section. What does not exist there, as the land of a tooth whose land is ground
/// away, is left out.
struct ToothSection {
  std::optional<double> edge;         ///< angle of the cutting edge on the blank's circle, counted as A is [rad]
  double edge_wheel_x = 0;            ///< X of the wheel's centre as it forms that edge [m]
  std::optional<double> rake;         ///< radial, at the edge as reliefs leave it [rad]
  std::optional<double> normal_rake;  ///< normal to the edge [rad]
  /// Radial, of the chord from the edge to the rake face at CutterGeometry::chordal_rake_depth: what a measuring
  /// machine finds, where the rake is the tangent at the edge, and may be that of a narrow facet [rad].
  std::optional<double> chordal_rake;
  std::optional<double> flute;   ///< angle that the flute takes at the outer circle [rad]
  std::optional<double> land;    ///< angle between this flute and the next one behind its edge [rad]
  double least_land = 0;         ///< the same where it is least, from the core out; 0 or less: none is left [rad]
  std::optional<double> spiral;  ///< of the ground edge against the axis [rad]
  double depth = 0;              ///< of the flute below the outer circle [m]
  bool complete = false;         ///< over its whole depth, as a longer stroke would leave it
  std::optional<ReliefSection> relief;  ///< of a tooth that has an edge and reliefs
};

/// How far below the edge the chord of a rake face ends. @param flute_depth [m].
double chordDepth(const CutterGeometry& cutter, double flute_depth) noexcept;

/// The radial angle of a chord of a right-hand rake face. @param outer,inner radii of its ends [m].
/// @param turn from the outer end to the inner one [rad].
double chordAngle(double outer, double inner, double turn) noexcept;

/// The spiral angle with which an edge would turn as far between two sections: the mean of its own there.
/// @param from,to X of the sections, not the same [m]. @param turn [rad].
double meanSpiral(const ConicalCutter& cutter, double from, double to, double turn) noexcept;

constexpr double kMinCore = 1e-6;  ///< radius of a core that still holds the teeth together [m]

/// A section of the ground cutter, normal to its axis.
struct GroundSection {
  double x = 0;            ///< [m]
  double radius = 0;       ///< of the blank [m]
  double core_radius = 0;  ///< least that flutes and reliefs leave; the blank's where nothing is removed [m]
  std::vector<ToothSection> teeth;
};

/// What strokes of the wheel remove together: a tooth's flute.
using Flute = std::vector<WheelSweep>;

/// What strokes of the wheel remove together: a relief of a tooth.
using Relief = std::vector<WheelSweep>;

/// The reliefs of a tooth, the first one first.
using Reliefs = std::vector<Relief>;

/// The wall that strokes leave together on a circle: of those that reach it, the one that goes farthest.
/// @param x,r of the circle [m]. @param high the end of their arc at the larger angle.
std::optional<Wall> outermostWall(const std::vector<WheelSweep>& strokes, double x, double r, bool high);

/// The least radius that strokes leave of a section. @param radius of the blank there [m].
double leastRadius(const std::vector<WheelSweep>& strokes, double x, double radius);

/// Where a flute is ground.
struct GroundTooth {
  double angle = 0;       ///< added to A of the flute's strokes [rad]
  std::size_t flute = 0;  ///< which
};

/// The cutter that a job's strokes leave, measured in sections. Teeth that share a flute cost no more than one.
class GroundCutter {
 public:
  /// @param flutes the distinct ones, for a tooth at angle 0.
  /// @param teeth in ascending angles within one turn.
  /// @param reliefs of the teeth of each flute, for a tooth at angle 0; empty if there are none.
  /// @throw std::invalid_argument if a flute has no strokes, if a tooth's is not there, or if only some have reliefs.
  GroundCutter(const ConicalCutter& cutter, std::vector<Flute> flutes, std::vector<GroundTooth> teeth,
               std::vector<Reliefs> reliefs = {});

  /// @param x of the section, where the blank has a radius [m].
  GroundSection section(double x) const;

  /// The area that is removed in a section [m^2].
  double areaRemoved(const GroundSection& section) const { return areaRemoved(section.x, section.core_radius); }

  /// Where all flutes are complete, to 10 um.
  /// @param from,to ends of the range that is looked at [m].
  /// @return the longest part about the range's middle; nothing if a flute is not complete there.
  std::optional<Range> completeRange(double from, double to) const;

  /// The volume that is removed between two sections, by the areas of some in between [m^3].
  double volumeRemoved(double from, double to, int sections) const;

  /// The arc that one of the flutes, of a tooth at angle 0, takes of the circle of radius `r` at `x`.
  std::optional<Arc> arc(const Flute& flute, double x, double r) const;

  const ConicalCutter& cutter() const noexcept { return cutter_; }
  CutDirection direction() const noexcept { return cutter_.geometry().cut; }
  const std::vector<Flute>& flutes() const noexcept { return flutes_; }
  const std::vector<GroundTooth>& teeth() const noexcept { return teeth_; }
  /// Of a tooth; as if it were at angle 0.
  const Reliefs& reliefs(std::size_t tooth) const;

  /// The tooth whose flute bounds a tooth's land, and how far behind it is.
  struct NextTooth {
    std::size_t tooth;
    double pitch;  ///< [rad]
  };
  NextTooth next(std::size_t tooth) const;

 private:
  /// Of a flute, on circles from the core out; nothing where it is not that deep.
  using Arcs = std::vector<std::optional<Arc>>;

  std::optional<Wall> rakeFace(const Flute& flute, double x, double r) const {
    return outermostWall(flute, x, r, direction() == CutDirection::kRightHand);
  }
  /// The rakes of a tooth whose edge is on the circle of radius `r`.
  void measureRake(const Flute& flute, double x, double r, ToothSection& section) const;
  double coreRadius(const Flute& flute, double x) const { return leastRadius(flute, x, cutter_.radius(x)); }
  double coreRadius(double x) const;
  double areaRemoved(double x, double core_radius) const;
  ToothSection measure(const Flute& flute, double x) const;
  bool isComplete(const Flute& flute, double x, double core_radius) const;
  bool arcIsComplete(const Flute& flute, double x, double r) const;
  bool isComplete(double x) const;
  void measureLand(std::size_t tooth, const std::vector<ToothSection>& measured, const std::vector<Arcs>& arcs,
                   ToothSection& section) const;
  bool landsAreAlike(std::size_t a, std::size_t b) const;

  ConicalCutter cutter_;
  std::vector<Flute> flutes_;
  std::vector<GroundTooth> teeth_;
  std::vector<Reliefs> reliefs_;
};

}  // namespace grinder
