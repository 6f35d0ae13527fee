#pragma once

#include "flute_grinder/job/grind_job.h"
#include "tool/change.h"
#include "tool/end_flutes.h"
#include "tool/face_sweep.h"

#include <functional>
#include <optional>
#include <vector>

namespace grinder {

/// A stroke on the end of a tool.
struct EndCut {
  std::size_t tooth = 0;
  OperationKind kind = OperationKind::kGash;  ///< on the end
  FaceSweep sweep;
};

/// An end tooth at a distance from the axis, on the rays of a line at right angles to the radius through the tooth's
/// angle. Without an edge that the tooth's own flute or gash and its own primary flank form, everything is empty.
struct EndSection {
  double r = 0;                            ///< distance of the line from the axis [m]
  std::optional<double> edge;              ///< X of the edge [m]
  double behind = 0;                       ///< distance of the edge from the radius, against the cut [m]
  std::optional<double> rake;              ///< axial rake at the edge, of the face that the gash leaves [rad]
  std::optional<double> clearance;         ///< axial clearance at the edge [rad]
  std::optional<double> dish;              ///< by which the primary flank is hollow toward the axis [rad]
  std::optional<double> land;              ///< width of the primary flank, seen along the axis, to the secondary [m]
  std::optional<double> second_clearance;  ///< axial clearance at the beginning of the secondary flank [rad]
};

/// The chamfer of a tooth between end and periphery.
struct ChamferFigures {
  double width = 0;      ///< seen along the axis [m]
  double angle = 0;      ///< of its edge to the axis [rad]
  double clearance = 0;  ///< normal to its edge [rad]
};

/// The end of a tool as strokes leave it, measured on rays parallel to the axis.
class GroundEnd {
 public:
  /// @param radius of the tool at its end [m].
  /// @param blank_x X of the blank's flat end, 0 or less [m].
  /// @param flutes flutes that were ground before; none: the gashes form all edges.
  GroundEnd(double radius, CutDirection cut, std::vector<double> tooth_angles, std::vector<EndCut> cuts, double blank_x,
            EndFlutes flutes = {});

  /// @param r distance from the axis, positive [m].
  EndSection section(std::size_t tooth, double r) const;
  /// The same with the edge alone.
  EndSection edgeAt(std::size_t tooth, double r) const;

  /// The smallest radius outside which a tooth's edge is whole, up to the corner; nothing if it is not whole even there
  /// [m].
  std::optional<double> wholeFrom(std::size_t tooth) const;

  /// The axial rake of the face that a tooth's gash leaves; nothing where the flute has taken it away [rad].
  /// @param r distance from the axis [m].
  /// @param x,behind a place on the edge, or where it is to be [m].
  std::optional<double> rake(std::size_t tooth, double r, double x, double behind) const;

  /// Whether strokes on the end, rather than flutes, remove a place.
  /// @param r,turn,x the place: distance from the axis [m], angle from the tooth's in the sense of A [rad], along the
  ///        axis [m].
  bool isRemovedOnEnd(std::size_t tooth, double r, double turn, double x) const;

  /// How far behind the end a tooth's gash runs into a core; 0 if it does not [m].
  /// @param core its radius at X, which grows along X by less than the gash's bottom rises [m].
  /// @param length of the core, the most that is returned [m].
  double gashedTo(std::size_t tooth, const std::function<double(double)>& core, double length) const;

  /// By which the end stands in front of a tooth's edge anywhere behind it, on a circle about the axis; 0 if nowhere.
  /// What is narrower than a fiftieth of the radius is found only where a face ends. The land of the next tooth, which
  /// may begin as far before the angle of that one, does not count.
  /// @param section of the tooth, with an edge.
  /// @param pitch angle to the next tooth [rad].
  double heelDrag(std::size_t tooth, const EndSection& section, double pitch) const;

  /// Nothing if the corner has no chamfer.
  std::optional<ChamferFigures> chamfer(std::size_t tooth) const;

 private:
  /// A ray by its distance from the axis [m], its angle in the sense of A [rad], and by its place.
  struct Ray {
    double r, angle;
    FaceSweep::OnRay at;
  };
  static Ray rayAt(double r, double angle);
  Ray rayAt(std::size_t tooth, double r, double behind) const;
  /// The surface that is left on a ray: its X, and the cut on the end or else the flute that formed it, or none.
  struct Surface {
    double x;
    const EndCut* cut;
    bool of_flute;
    bool isAlike(const Surface& other) const { return cut == other.cut && of_flute == other.of_flute; }
  };
  Surface surface(const Ray& ray) const;
  Surface surface(std::size_t tooth, double r, double behind) const;
  enum class By { kAny, kOwnGash, kOwnFace };
  bool isRemoved(std::size_t tooth, double r, double behind, double x, By by) const;
  bool isFlank(std::size_t tooth, OperationKind kind, double r, double behind) const;
  /// How far behind the radius the tooth has an edge that its flute or gash and this flank form.
  std::optional<double> edge(std::size_t tooth, OperationKind kind, double r, int halvings = kExactHalvings) const;
  double slope(std::size_t tooth, double r, double behind) const;
  void measureFlanks(std::size_t tooth, EndSection& section) const;

  double radius_;
  double hand_;
  std::vector<double> tooth_angles_;
  std::vector<EndCut> cuts_;
  double blank_x_;
  EndFlutes flutes_;
};

}  // namespace grinder
