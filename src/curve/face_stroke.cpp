#include "flute_grinder/curve/face_stroke.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

using Eigen::Vector3d;

constexpr int kFaceSteps = 2000;     ///< most steps to the centre of a face, each of which finds it more exactly
constexpr double kLastStep = 1e-13;  ///< length of a step after which the next is lost in rounding [m]
constexpr int kTurnSteps = 90;       ///< steps of a whole turn, to where a rim comes near the next tooth
constexpr int kTurnHalvings = 60;    ///< halvings of such a step
constexpr double kOnRim = 1e-9;      ///< tolerance for the place of a rim [m]
/// Where a flank ends if the next tooth is far: `before` that tooth, but from `least` to `most` behind its own edge
/// [rad]. The gash takes the rest.
struct FlankEnd {
  double before, least, most;
};
/// A rim that came to an opposite tooth would end beyond the axis.
constexpr FlankEnd kFlankEnd{40 * units::kDegree, 140 * units::kDegree, 160 * units::kDegree};
/// The same where the rim passes the axis; `most` is without what the rim turns by in doing so.
constexpr FlankEnd kEndPastAxis{10 * units::kDegree, 180 * units::kDegree, 180 * units::kDegree};

/// How far behind its edge a flank ends: at the next tooth, or before it.
double endOfFlank(const EndTooth& tooth) {
  const bool passes = tooth.past_axis > 0;
  const FlankEnd& end = passes ? kEndPastAxis : kFlankEnd;
  // Half of it keeps the rim off its own edge.
  const double turned = passes ? std::asin(std::min(1.0, tooth.past_axis / tooth.next_from)) / 2 : 0;
  return std::min(tooth.pitch, std::clamp(tooth.pitch - end.before, end.least, end.most + turned));
}

/// A place of a tooth in the machine, while the tooth stands at an angle.
Vector3d inMachine(const OnTooth& place, double tooth, CutDirection cut) {
  const double behind = cut == CutDirection::kRightHand ? place[2] : -place[2];
  const double cos = std::cos(tooth), sin = std::sin(tooth);
  return {place[0], place[1] * cos - behind * sin, place[1] * sin + behind * cos};
}

/// The spindle's axis, up at swivel 0.
Vector3d spindleAt(double swivel) { return {-std::sin(swivel), 0, std::cos(swivel)}; }

/// The axes while the wheel's centre is at a place of the machine.
Axes axesAt(const Vector3d& centre, double tooth, double radius, const FaceWheel& wheel) {
  Axes axes;
  axes << centre[0], centre[1] - radius - wheel.nominal_radius, centre[2] - wheel.height, -tooth;
  return axes;
}

/// In the plane of the wheel's faces: along Y, and across it from the axis at X = 0.
using InFace = Eigen::Vector2d;

Vector3d acrossAt(double swivel) { return {std::cos(swivel), 0, std::sin(swivel)}; }

/// What of the next tooth, or of where a wide flank ends, must stay outside the wheel, as seen along the spindle from
/// the axis outward: its edge, and the place under the edge, along X, on the plane that is ground.
struct NextTooth {
  std::array<std::array<InFace, 2>, 2> lines;
  InFace axis;  ///< where the plane meets the axis

  /// @param place a place on the plane.
  NextTooth(const EndTooth& tooth, const OnTooth& normal, const FacePose& pose, const Vector3d& place) {
    const double pitch = endOfFlank(tooth);
    const double turn = tooth.cut == CutDirection::kRightHand ? pitch : -pitch;
    const double y = tooth.radius * std::cos(pose.tooth + turn), z = tooth.radius * std::sin(pose.tooth + turn);
    const double sin = std::sin(pose.swivel), cos = std::cos(pose.swivel);
    const double hollow = tooth.radius * normal[1] / normal[0];
    const double under = (place[0] - place[2] * cos / sin) * cos;
    lines = {{{InFace(0, hollow * cos), InFace(y, z * sin)}, {InFace(0, under), InFace(y, z / sin + under)}}};
    axis = lines[1][0];
    for (auto& [inner, outer] : lines) inner += tooth.next_from / tooth.radius * (outer - inner);
  }
};

/// The distance of a place from a line between two others.
double distance(const std::array<InFace, 2>& line, const InFace& place) {
  const InFace way = line[1] - line[0];
  const double part = std::clamp((place - line[0]).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (place - line[0] - part * way).norm();
}

/// How far a place is from what the rim about it may not touch: the nearest of the next tooth, or for a cup, whose rim
/// goes round that tooth, the farthest.
double toNext(const NextTooth& next, const InFace& place, bool round) {
  if (!round) return std::min(distance(next.lines[0], place), distance(next.lines[1], place));
  double farthest = 0;
  for (const auto& line : next.lines) {
    for (const InFace& end : line) farthest = std::max(farthest, (end - place).norm());
  }
  return farthest;
}

/// The centre of the face of a wheel whose rim is outside the next tooth, as near to the axis as that allows.
/// @param rim radius of the wheel, with the gap [m].
InFace besideNext(const NextTooth& next, double rim) {
  const auto& [inner, outer] = next.lines[1];
  const InFace outward = (outer - inner).normalized(), toward(outward[1], -outward[0]);
  InFace centre = inner + rim * toward;
  double step = rim;
  for (int i = 0; i < kFaceSteps && step > kLastStep; ++i) {
    step = rim - toNext(next, centre, false);
    centre += std::max(0.0, step) * toward;
  }
  return centre;
}

/// The centre of the face of a cup whose rim goes round the next tooth.
/// @param rim inner radius of the rim, less the gap [m].
InFace roundNext(const NextTooth& next, double rim) {
  const auto& [inner, outer] = next.lines[1];
  const InFace outward = (outer - inner).normalized(), toward(outward[1], -outward[0]);
  const double half = (outer - inner).norm() / 2;
  InFace centre = (inner + outer) / 2 + std::sqrt(std::max(0.0, rim * rim - half * half)) * toward;
  double step = toNext(next, centre, true) - rim;
  for (int i = 0; i < kFaceSteps && step > kLastStep; ++i) {
    const InFace nearer = centre - step * toward;
    const double left = toNext(next, nearer, true) - rim;
    if (!(left < step)) break;  // a rim that is too small
    centre = nearer, step = left;
  }
  return centre;
}

/// The centre of the face of a wheel whose rim passes the axis, and has the next tooth on its other side, as near as
/// that allows.
/// @param from_axis distance of the centre from the axis [m].
/// @param rim radius of the rim, with the gap to the next tooth [m].
/// @param round whether that tooth is within the rim.
InFace pastAxis(const NextTooth& next, double from_axis, double rim, bool round) {
  const InFace outward = (next.lines[1][1] - next.lines[1][0]).normalized();
  const auto at = [&](double turn) { return InFace(next.axis + from_axis * (Eigen::Rotation2Dd(-turn) * outward)); };
  const auto is_nearer = [&](double turn) { return toNext(next, at(turn), round) < rim; };
  // Turned away from the next tooth, the centre comes farther from both of its lines.
  constexpr double kStep = units::kTurn / kTurnSteps;
  double far = 0.75 * units::kTurn;
  for (int i = 0; i < kTurnSteps && (is_nearer(far) || !is_nearer(far - kStep)); ++i) far -= kStep;
  double near = far - kStep;
  // Where the rim is clear nowhere, there is least missing in line with the next tooth: for the refusal.
  if (is_nearer(far) || !is_nearer(near)) return at(round ? 0 : units::kTurn / 2);
  for (int i = 0; i < kTurnHalvings; ++i) {
    const double turn = (near + far) / 2;
    (is_nearer(turn) ? near : far) = turn;
  }
  return at(far);
}

/// A stroke that only ends, at the centre of the lower face in its plane.
/// @param place a place in the plane.
FaceStroke flankStroke(const EndTooth& tooth, const FacePose& pose, const Vector3d& place, const InFace& centre,
                       const FaceWheel& wheel) {
  const Vector3d spindle = spindleAt(pose.swivel);
  const double along_spindle = place.dot(spindle) + wheel.width / 2 - wheel.face_wear;
  FaceStroke stroke;
  stroke.swivel = pose.swivel;
  stroke.to = axesAt(centre[0] * Vector3d::UnitY() + centre[1] * acrossAt(pose.swivel) + along_spindle * spindle,
                     pose.tooth, tooth.radius, wheel);
  stroke.from = stroke.to;
  stroke.per_stock[kX] = -1 / std::sin(pose.swivel);
  return stroke;
}

}  // namespace

OnTooth flankNormal(double colatitude, double clearance, double spiral) noexcept {
  const OnTooth surface(-std::cos(colatitude), std::sin(colatitude), 0);
  const OnTooth generatrix(std::sin(colatitude), std::cos(colatitude), 0);
  const OnTooth behind = std::cos(spiral) * OnTooth::UnitZ() - std::sin(spiral) * generatrix;
  return std::cos(clearance) * surface + std::sin(clearance) * behind;
}

OnTooth endNormal(double clearance, double dish) noexcept {
  return OnTooth(-1, -std::tan(dish), std::tan(clearance)).normalized();
}

OnTooth gashNormal(double rake, double dish) noexcept {
  return OnTooth(std::sin(rake), std::tan(dish) * std::sin(rake), -std::cos(rake)).normalized();
}

FacePose flankPose(const OnTooth& normal, CutDirection cut) noexcept {
  const double swivel = std::asin(std::clamp(-normal[0], -1.0, 1.0));
  const double tooth = units::kPi / 2 - std::atan2(normal[2], normal[1]);
  return {swivel, cut == CutDirection::kRightHand ? tooth : units::kPi - tooth};
}

FacePose gashPose(const OnTooth& normal, CutDirection cut) noexcept {
  const double hand = cut == CutDirection::kRightHand ? 1 : -1;
  const double swivel = std::asin(std::clamp(normal[0], -1.0, 1.0));
  return {hand * swivel, hand * (units::kPi / 2 - std::atan2(-normal[2], -normal[1]))};
}

OnTooth chamferNormal(double angle, double clearance, double dish, double tan_rake, double tan_hook) noexcept {
  // From the end's edge to the periphery the rake face falls back by what the chamfer's edge rises along the axis, and
  // comes forward by what it goes outward.
  const double behind = (std::cos(angle) + std::sin(angle) * std::tan(dish)) * tan_rake - std::sin(angle) * tan_hook;
  return flankNormal(units::kPi / 2 - angle, clearance, std::atan(behind));
}

FaceStroke endStroke(const EndTooth& tooth, const OnTooth& normal, const OnTooth& through, const FaceWheel& wheel,
                     double gap, double clear) {
  const FacePose pose = flankPose(normal, tooth.cut);
  const Vector3d spindle = spindleAt(pose.swivel), place = inMachine(through, pose.tooth, tooth.cut);
  const bool right = tooth.cut == CutDirection::kRightHand;
  const double rim = right ? wheel.radius + gap : wheel.inner_radius - gap;
  const NextTooth next(tooth, normal, pose, place);
  const double from_axis = right ? wheel.radius - tooth.past_axis : wheel.inner_radius + tooth.past_axis;
  const InFace centre = tooth.past_axis > 0 ? pastAxis(next, from_axis, rim, !right)
                        : right             ? besideNext(next, rim)
                                            : roundNext(next, rim);
  const double off = std::abs(toNext(next, centre, !right) - rim);
  if (!(off <= kOnRim)) {
    throw std::invalid_argument(
        format("the wheel's rim cannot end clear of the next tooth, by %.3g mm; allowed: a flank "
               "and a wheel with which it can",
               off / units::kMillimetre));
  }
  FaceStroke stroke = flankStroke(tooth, pose, place, centre, wheel);
  if (right) {
    stroke.from[kY] = clear + wheel.radius - wheel.nominal_radius;
  } else {
    stroke.from[kX] -= clear / std::sin(pose.swivel) + 2 * tooth.radius * std::abs(spindle[2] / spindle[0]);
  }
  return stroke;
}

FaceStroke chamferStroke(const EndTooth& tooth, const OnTooth& normal, const OnTooth& through, const FaceWheel& wheel,
                         double gap, double clear) noexcept {
  const FacePose pose = flankPose(normal, tooth.cut);
  const Vector3d place = inMachine(through, pose.tooth, tooth.cut);
  // Where the flank leaves the periphery at the end, behind the edge: N . (0, R cos, R sin) is as at the edge.
  const double part = normal.dot(through) / (tooth.radius * std::hypot(normal[1], normal[2]));
  const double behind = std::atan2(normal[2], normal[1]) + std::acos(std::clamp(part, -1.0, 1.0));
  const double turn = tooth.cut == CutDirection::kRightHand ? behind : -behind;
  // A left-hand edge may fall from the periphery to the end, there to at most the radius through the corner.
  const double lowest =
      std::min({place[1], tooth.radius * std::cos(pose.tooth), tooth.radius * std::cos(pose.tooth + turn)});
  const InFace centre(lowest - gap + wheel.radius, place.dot(acrossAt(pose.swivel)));
  FaceStroke stroke = flankStroke(tooth, pose, place, centre, wheel);
  stroke.from[kY] = clear + wheel.radius - wheel.nominal_radius;
  return stroke;
}

namespace {

/// The way along a gash's bottom, from the end outward, at which the wheel is clear of the blank and its corner.
/// @param height of the blank's corner above the bottom's end [m].
double wayClearOfBlank(double height, double angle, double wheel_radius, double clear) noexcept {
  const double sin = std::sin(angle), cos = std::cos(angle);
  const double across = wheel_radius - height * cos;  // from the corner to the way of the wheel's centre
  const double off_corner = height * sin + std::sqrt(std::pow(wheel_radius + clear, 2) - across * across);
  const bool before_end = off_corner * cos <= wheel_radius * sin;  // else the blank below the centre is nearest
  return before_end ? off_corner : (height + clear + wheel_radius * (1 - cos)) / sin;
}

}  // namespace

FaceStroke gashStroke(const EndTooth& tooth, const OnTooth& normal, double angle, double past, const FaceWheel& wheel,
                      double clear) noexcept {
  const FacePose pose = gashPose(normal, tooth.cut);
  const double hand = tooth.cut == CutDirection::kRightHand ? 1 : -1;
  const Vector3d spindle = spindleAt(pose.swivel);
  const Vector3d along = acrossAt(pose.swivel);
  const Vector3d corner = inMachine({0, tooth.radius, 0}, pose.tooth, tooth.cut);
  // The face's plane holds the corner, which is at X = 0, and is parallel to Y: its point at X = Y = 0.
  const Vector3d origin(0, 0, corner[2]);
  const auto axes = [&](double way) {
    const double u = way * std::cos(angle) - wheel.radius * std::sin(angle);
    const double v = -past + way * std::sin(angle) + wheel.radius * std::cos(angle);
    const Vector3d face = origin + u * along + v * Vector3d::UnitY();
    return axesAt(face - hand * (wheel.width / 2 - wheel.face_wear) * spindle, pose.tooth, tooth.radius, wheel);
  };
  FaceStroke stroke;
  stroke.swivel = pose.swivel;
  stroke.from = axes(wayClearOfBlank(tooth.radius + past, angle, wheel.radius, clear));
  stroke.to = axes(0);
  stroke.per_stock[kY] = 1;
  return stroke;
}

}  // namespace grinder
