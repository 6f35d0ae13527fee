#pragma once

#include <Eigen/Core>

namespace grinder {

class ValidJob;

/// The work A at which the rake face of a job's first tooth touches a ball in its flute, such as a probe's ball. A
/// turns toward it from a position where the ball is free: upward for a right-hand cutter, downward for a left-hand
/// one. Takes some tens of milliseconds, or some tenths of a second for a refusal.
/// @param job job with its law of Z: withLaws().
/// @param ball centre of the ball in the work frame: X from the small end along the axis, Y from the axis toward the
///        wheel, Z up [m].
/// @param ball_diameter diameter of the ball [m].
/// @return A of the tooth at angle 0, with whole turns, to 1e-7 rad [rad].
/// @throw ReasonError if the ball is outside the flute's length, or touches the flute's floor, the other wall or the
///        cutting edge first; it has the allowed distances of the ball from the axis, or an allowed diameter.
/// @throw like groundCutterOf().
double rakeTouchAngle(const ValidJob& job, const Eigen::Vector3d& ball, double ball_diameter);

}  // namespace grinder
