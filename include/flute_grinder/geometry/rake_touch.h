#pragma once

#include <Eigen/Core>

namespace grinder {

class ValidJob;

/// The work A at which the rake face of a job's first tooth comes to a ball that stands in its flute, as a measuring
/// probe does. A turns there from where the ball stands free: upward for a right-hand cutter, downward for a left-hand
/// one. Takes some tens of milliseconds, a refusal some tenths of a second.
/// @param job with its law of Z: withLaws().
/// @param ball its centre in the frame of the work: from the small end along the axis, from the axis toward the wheel,
///        up [m].
/// @param ball_diameter [m].
/// @return A of the tooth at angle 0, not taken off whole turns, to 1e-7 rad [rad].
/// @throw ReasonError if the ball is not within the flute's length, or touches the flute's floor, its other wall
///        or the cutting edge first, with the ball's distances from the axis that are allowed, or a diameter.
/// @throw as groundCutterOf().
double rakeTouchAngle(const ValidJob& job, const Eigen::Vector3d& ball, double ball_diameter);

}  // namespace grinder
