#include "flute_grinder/curve/face_stroke.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

using Eigen::Vector3d;

constexpr double kOpposite = units::kPi / 6;  ///< angle within which the next tooth is about opposite

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

/// The edge of the next tooth as it is seen along X on the plane of the face.
struct NextEdge {
  bool is_opposite;      ///< about opposite to the tooth, so that it is on the other side of the axis
  double along, across;  ///< direction from the axis outward, of unit length: along Y, and in the plane across it
  double length;         ///< [m]
};

NextEdge nextEdge(const EndTooth& tooth, const FacePose& pose) {
  const double turn = tooth.cut == CutDirection::kRightHand ? tooth.pitch : -tooth.pitch;
  const double along = std::cos(pose.tooth + turn), across = std::sin(pose.tooth + turn) / std::sin(pose.swivel);
  const double stretch = std::hypot(along, across);
  return {std::abs(tooth.pitch - units::kPi) < kOpposite, along / stretch, across / stretch, tooth.radius * stretch};
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

FaceStroke endStroke(const EndTooth& tooth, const OnTooth& normal, const OnTooth& through, const FaceWheel& wheel,
                     double gap, double clear) noexcept {
  const FacePose pose = flankPose(normal, tooth.cut);
  const Vector3d spindle = spindleAt(pose.swivel), place = inMachine(through, pose.tooth, tooth.cut);
  const bool right = tooth.cut == CutDirection::kRightHand;
  // Along Y and across it, in the face's plane: the centre of the face from the axis.
  const NextEdge next = nextEdge(tooth, pose);
  double along = 0, across = 0;
  if (next.is_opposite) {
    along = right ? wheel.radius + gap : wheel.inner_radius - gap;
  } else {
    // The rim of a wheel touches the next tooth's edge at the axis; that of a cup goes round the edge.
    const double rim = right ? wheel.radius + gap : wheel.inner_radius - gap, middle = right ? 0 : next.length / 2;
    along = rim * next.across + middle * next.along;
    across = -rim * next.along + middle * next.across;
  }
  const double y = along, z = across * std::sin(pose.swivel);
  // The face's centre lies in the plane: spindle . (face - place) = 0.
  const double x = place[0] + (z - place[2]) * spindle[2] / -spindle[0];
  const Vector3d centre = Vector3d(x, y, z) + (wheel.width / 2 - wheel.face_wear) * spindle;

  FaceStroke stroke;
  stroke.swivel = pose.swivel;
  stroke.to = axesAt(centre, pose.tooth, tooth.radius, wheel);
  stroke.from = stroke.to;
  if (right) {
    stroke.from[kY] = clear + wheel.radius - wheel.nominal_radius;
  } else {
    stroke.from[kX] -= clear / std::sin(pose.swivel) + 2 * tooth.radius * std::abs(spindle[2] / spindle[0]);
  }
  stroke.per_stock[kX] = -1 / std::sin(pose.swivel);
  return stroke;
}

double leastCupGap(const EndTooth& tooth, const OnTooth& normal, const FaceWheel& wheel) noexcept {
  const NextEdge next = nextEdge(tooth, flankPose(normal, tooth.cut));
  const double half = next.is_opposite ? 0 : next.length / 2;
  return wheel.inner_radius - std::sqrt(wheel.inner_radius * wheel.inner_radius - half * half);
}

FaceStroke gashStroke(const EndTooth& tooth, const OnTooth& normal, double angle, double past, const FaceWheel& wheel,
                      double clear) noexcept {
  const FacePose pose = gashPose(normal, tooth.cut);
  const double hand = tooth.cut == CutDirection::kRightHand ? 1 : -1;
  const Vector3d spindle = spindleAt(pose.swivel);
  const Vector3d along(std::cos(pose.swivel), 0, std::sin(pose.swivel));
  const Vector3d corner = inMachine({0, tooth.radius, 0}, pose.tooth, tooth.cut);
  // Where the face's plane crosses X = 0 and Y = 0.
  const Vector3d origin(0, 0, corner[2] - spindle[0] / spindle[2] * (0 - corner[0]));
  const auto axes = [&](double way) {
    const double u = way * std::cos(angle) - wheel.radius * std::sin(angle);
    const double v = -past + way * std::sin(angle) + wheel.radius * std::cos(angle);
    const Vector3d face = origin + u * along + v * Vector3d::UnitY();
    return axesAt(face - hand * (wheel.width / 2 - wheel.face_wear) * spindle, pose.tooth, tooth.radius, wheel);
  };
  FaceStroke stroke;
  stroke.swivel = pose.swivel;
  stroke.from = axes((tooth.radius + clear + past) / std::sin(angle));
  stroke.to = axes(0);
  stroke.per_stock[kY] = 1;
  return stroke;
}

}  // namespace grinder
