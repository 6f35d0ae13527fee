#pragma once

#include "second_opinion.h"

// Where the straight strokes on the end of a tool must be, computed anew from what is asked of that end, by other ways
// than the product's. Knows nothing of the product's code.
namespace second_opinion {

/// A plane on the end of a tool, at one of its teeth, and the wheel whose face grinds it.
struct Face {
  enum class Kind { kGash, kEnd, kChamfer };

  Kind kind = Kind::kGash;
  bool left_hand = false;
  Real radius = 0;            ///< of the tool at its end [m]
  Real pitch = 0;             ///< to the tooth behind [rad]
  Real behind_from = 0;       ///< radius from which that tooth has an edge [m]
  Real past_axis{};           ///< by which the rim ends past the axis; 0: beside all of that edge
  Real a = 0;                 ///< of the tooth's edge [rad]
  Real dish = 0, rake = 0;    ///< of the end [rad]
  Real clearance = 0;         ///< of the plane [rad]
  Real land = 0;              ///< of another flank before it, seen along the axis; 0: none [m]
  Real first_clearance = 0;   ///< of the flank at the end's edge [rad]
  Real width = 0;             ///< of a chamfer, seen along the axis [m]
  Real angle = 0;             ///< to the axis, of a chamfer or of a gash's bottom [rad]
  Real spiral = 0, hook = 0;  ///< tangents: how the flute's edge trails along the axis, and its face inward
  Real past = 0;              ///< of a gash's bottom [m]
  Real swivel = 0;            ///< of the set-up [rad]
  Real height = 0, wheel_radius = 0, wheel_width = 0;  ///< of the set-up, and of the wheel without wear [m]
  Real rim = 0;                                        ///< width of a cup's rim [m]
  Real gap = 0;                                        ///< between rim and next tooth [m]
  Real clear = 0;                                      ///< between wheel and blank where a stroke begins [m]
  Real stock = 0;                                      ///< by which the blank is too long [m]
};

/// Judges the ends of a stroke: that the wheel's face is in the plane, and the rim where it may be.
/// @throw Violation
void judge(const Face& face, const Pass& pass);

}  // namespace second_opinion
