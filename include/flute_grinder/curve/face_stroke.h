#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/curve/conical_cutter.h"

#include <Eigen/Core>

namespace grinder {

/// A direction or a place on a tooth: along the axis from the end toward the shank, along the radius through the
/// tooth's edge at the end, and behind the edge.
using OnTooth = Eigen::Vector3d;

/// How a plane of a tooth comes to lie on a face of the wheel. The faces are parallel to Y at every swivel, so a plane
/// has one swivel and one angle of the tooth, and the wheel moves along Y within the plane.
struct FacePose {
  double swivel = 0;  ///< as for a flute [rad]
  double tooth = 0;   ///< machine angle of the tooth, from Y toward Z: A is the tooth's own angle less this [rad]
};

/// The outward normal of a plane flank behind an edge on a surface of revolution.
/// @param colatitude angle from the axis to the surface's normal: 0 for a flat end, minus the dish for a dished one, a
///        quarter turn for the periphery [rad].
/// @param clearance angle between flank and surface, normal to the edge [rad].
/// @param spiral angle of the edge to the surface's generatrix; positive if the edge trails toward the shank [rad].
OnTooth flankNormal(double colatitude, double clearance, double spiral = 0) noexcept;

/// The outward normal of the flank of an end tooth.
/// @param clearance axial clearance, in the section along a circle about the axis [rad].
/// @param dish angle by which the end is hollow toward the axis [rad].
OnTooth endNormal(double clearance, double dish) noexcept;

/// The outward normal of the rake face of an end tooth, toward the chip.
/// @param rake axial rake, in the section along a circle about the axis [rad].
/// @param dish as for endNormal() [rad].
OnTooth gashNormal(double rake, double dish) noexcept;

/// The pose in which the wheel's lower face grinds a plane that faces the end. A left-hand tooth stands on the far side
/// of the axis, in the mirror image in Y; in the mirror image in Z, the spindle would be on the side of the work.
/// @param normal outward, of unit length.
FacePose flankPose(const OnTooth& normal, CutDirection cut) noexcept;

/// The pose in which the wheel's upper face grinds a rake face. A left-hand one is ground by the lower face, in the
/// mirror image in Z.
/// @param normal outward, of unit length.
FacePose gashPose(const OnTooth& normal, CutDirection cut) noexcept;

/// The wheel that grinds a plane.
struct FaceWheel {
  double nominal_radius = 0;  ///< radius of the wheel that touches the small end's circle at Y = 0 [m]
  double radius = 0;          ///< present radius [m]
  double width = 0;           ///< width without wear [m]
  double face_wear = 0;       ///< wear of the face that grinds [m]
  double height = 0;          ///< height of the wheel's centre above the cutter's axis at Z = 0 [m]
  double inner_radius = 0;    ///< inner radius of a cup's rim; 0 for a wheel without a recess [m]
};

/// The end of a tool at one of its teeth.
struct EndTooth {
  double radius = 0;  ///< radius of the tool at its end [m]
  double pitch = 0;   ///< angle to the next tooth behind the edge [rad]
  CutDirection cut = CutDirection::kRightHand;
  /// Radius outside which the next tooth has an edge [m].
  double next_from = 0;
  /// Distance by which the rim passes the axis, for an edge up to it; not without `next_from`. 0: as far as the next
  /// tooth's edge allows [m].
  double past_axis = 0;
};

/// A straight stroke at constant A, during which the wheel's face stays in one plane.
struct FaceStroke {
  double swivel = 0;              ///< [rad]
  Axes from = Axes::Zero();       ///< beginning, clear of a blank that ends at X = 0; A for a tooth at angle 0 [m, rad]
  Axes to = Axes::Zero();         ///< end [m], A [rad]
  Axes per_stock = Axes::Zero();  ///< shift of the whole stroke for each metre of stock that it leaves
};

/// The stroke that grinds a flank of an end tooth. For a right-hand tool the wheel comes down along Y until its rim has
/// passed the axis by as much as the next tooth's edge allows, or as is asked. For a left-hand one a cup comes along X,
/// the inner edge of its rim round the next tooth. Before a far tooth a flank ends earlier, and what is left of the
/// heel is the gash's: 40 deg before that tooth, but from 140 to 160 deg behind its own edge. With `past_axis` it ends
/// 10 deg before, but from 180 deg to 180 deg + asin(past_axis / next_from) / 2. Stock is normal to the flank.
/// @param normal outward, from endNormal().
/// @param through a place on the flank.
/// @param gap least distance of the rim from the next tooth's edge; with `past_axis`, gap and `past_axis` together
///        less than `next_from` [m].
/// @param clear distance of the wheel from the blank at the beginning [m].
/// @throw std::invalid_argument if the rim cannot end there.
FaceStroke endStroke(const EndTooth& tooth, const OnTooth& normal, const OnTooth& through, const FaceWheel& wheel,
                     double gap, double clear);

/// The outward normal of the flank of a chamfer between end and periphery.
/// @param angle between chamfer and axis [rad].
/// @param clearance normal to the chamfer's edge [rad].
/// @param dish of the end, as for endNormal() [rad].
/// @param tan_rake tangent of the rake face's angle to the axis at the corner: of the helix, or of the gash.
/// @param tan_hook tangent of its angle to the radius there: of the radial rake; 0 of a gash.
OnTooth chamferNormal(double angle, double clearance, double dish, double tan_rake, double tan_hook = 0) noexcept;

/// The stroke that grinds the flank of a chamfer, with the wheel's lower face: down along Y, until the rim has passed
/// all of the flank. Stock is normal to the flank.
/// @param normal outward, from chamferNormal().
/// @param through a place on the chamfer's edge, on the periphery.
/// @param gap distance by which the rim passes [m].
/// @param clear as for endStroke() [m].
FaceStroke chamferStroke(const EndTooth& tooth, const OnTooth& normal, const OnTooth& through, const FaceWheel& wheel,
                         double gap, double clear) noexcept;

/// The stroke that gashes an end tooth with the wheel's rim: inward along the gash's bottom, to the end. Stock is
/// radial, as for a flute.
/// @param normal outward, from gashNormal().
/// @param angle angle of the gash's bottom to the axis, positive [rad].
/// @param past distance by which the bottom is past the axis at the end; negative before it [m].
/// @param clear as for endStroke() [m].
FaceStroke gashStroke(const EndTooth& tooth, const OnTooth& normal, double angle, double past, const FaceWheel& wheel,
                      double clear) noexcept;

}  // namespace grinder
