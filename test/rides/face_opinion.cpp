#include "face_opinion.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace second_opinion {

namespace {

using Vector = std::array<Real, 3>;

constexpr Real kExact = 1e-12L;  ///< [m], [rad]
constexpr Real kNear = 1e-9L;    ///< of what the product approaches step by step [m]

Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector less(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector unit(const Vector& a) {
  const Real length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

void require(bool holds, const char* what, Real value, Real asked) {
  if (holds) return;
  throw Violation(std::string("stroke on the end: ") + what + " = " + std::to_string(value * 1e6L) + "e-6, asked " +
                  std::to_string(asked * 1e6L) + "e-6");
}
void requireSame(const char* what, Real value, Real asked, Real within = kExact) {
  require(std::abs(value - asked) <= within, what, value, asked);
}

/// A plane with its outward normal and a place on it: along the axis, along the tooth's radius, behind its edge.
struct Plane {
  Vector normal, through;
};

/// A chamfer's edge leads from the end's edge to the flute's; its flank falls away from the cone through that edge.
Plane chamferOf(const Face& f) {
  const Real hollow = std::tan(f.dish) + f.hook * std::tan(f.first_clearance);
  const Vector inner{f.width * hollow, f.radius - f.width, f.width * f.hook};
  const Real x = inner[0] + f.width / std::tan(f.angle), round = x * f.spiral / f.radius;
  const Vector edge = unit(less({x, f.radius, x * f.spiral}, inner));
  const Vector cone{-std::sin(f.angle), std::cos(f.angle), 0}, behind = unit(cross(edge, cone));
  Vector normal;
  for (std::size_t i = 0; i < 3; ++i) normal[i] = std::cos(f.clearance) * cone[i] + std::sin(f.clearance) * behind[i];
  return {normal, {x, f.radius * std::cos(round), f.radius * std::sin(round)}};
}

/// What of a plane does not depend on how it is ground: through the edge, and a line behind it in the plane.
Plane planeOf(const Face& f) {
  if (f.kind == Face::Kind::kChamfer) return chamferOf(f);
  const Vector inward{std::tan(f.dish), -1, 0};
  const Vector corner{f.land * std::tan(f.first_clearance), f.radius, f.land};
  if (f.kind == Face::Kind::kEnd) return {unit(cross(inward, {std::tan(f.clearance), 0, 1})), corner};
  return {unit(cross({1, 0, std::tan(f.rake)}, inward)), corner};
}

/// The wheel while it grinds a plane.
struct Pose {
  Vector spindle{}, across{};  ///< directions in the machine: up along the spindle, and across Y in the face's plane
  Real tooth = 0;              ///< angle of the tooth
  bool upper = false;          ///< the face
};

Pose poseOf(const Face& f, const Plane& plane) {
  const Real hand = f.left_hand ? -1 : 1;
  const Vector& n = plane.normal;
  Pose pose;
  Real swivel;
  if (f.kind == Face::Kind::kGash) {
    swivel = hand * std::asin(n[0]);
    pose.tooth = -hand * std::atan(std::tan(f.dish) * std::tan(f.rake));
    pose.upper = !f.left_hand;
  } else {
    // Of a flank at the end itself, tan = hypot(tan clearance, tan dish) from upright.
    swivel = f.kind == Face::Kind::kChamfer
                 ? std::asin(-n[0])
                 : std::acos(Real(-1)) / 2 - std::atan(std::hypot(std::tan(f.clearance), std::tan(f.dish)));
    const Real right = std::atan2(n[1], n[2]);
    pose.tooth = f.left_hand ? std::acos(Real(-1)) - right : right;
  }
  requireSame("swivel", f.swivel, swivel);
  pose.spindle = {-std::sin(swivel), 0, std::cos(swivel)};
  pose.across = {std::cos(swivel), 0, std::sin(swivel)};
  return pose;
}

/// A place on a tooth turned to an angle of the machine.
Vector inMachine(const Face& f, const Vector& place, Real tooth) {
  const Real behind = f.left_hand ? -place[2] : place[2];
  return {place[0], place[1] * std::cos(tooth) - behind * std::sin(tooth),
          place[1] * std::sin(tooth) + behind * std::cos(tooth)};
}

/// The centre of the face that grinds, in the machine.
Vector faceAt(const Face& f, const Pose& pose, const Point& at, Real face_wear) {
  const Real half = (pose.upper ? 1 : -1) * (f.wheel_width / 2 - face_wear);
  return {Real(at[0]) + half * pose.spindle[0], f.radius + f.wheel_radius + Real(at[1]),
          f.height + Real(at[2]) + half * pose.spindle[2]};
}

/// The least distance of a place of the face's plane from the line between two places, all as (across, Y).
Real nearest(Real u, Real v, const std::array<std::array<Real, 2>, 2>& line) {
  const Real du = line[1][0] - line[0][0], dv = line[1][1] - line[0][1];
  const Real part = ((u - line[0][0]) * du + (v - line[0][1]) * dv) / (du * du + dv * dv);
  const Real at = std::clamp(part, Real(0), Real(1));
  return std::hypot(u - line[0][0] - at * du, v - line[0][1] - at * dv);
}

struct NextTooth {
  std::array<std::array<Real, 2>, 2> edge, below;  ///< its edge, and what is under that on the plane
  std::array<Real, 2> at_axis{};                   ///< what of the plane is on the axis
};

/// How far behind its edge a flank ends: at the next tooth, or 40 deg before, from 140 to 160 deg; where the rim passes
/// the axis 10 deg before, from 180 deg to asin(past / from) / 2 more.
Real endOfFlank(const Face& f) {
  const Real deg = std::acos(Real(-1)) / 180;
  if (f.past_axis == 0) return std::min(f.pitch, std::clamp(f.pitch - 40 * deg, 140 * deg, 160 * deg));
  const Real most = 180 * deg + std::asin(f.past_axis / f.behind_from) / 2;
  return std::min(f.pitch, std::clamp(f.pitch - 10 * deg, 180 * deg, most));
}

/// The next tooth, or a line before it where the flank ends, as seen along the spindle: (across, Y).
NextTooth nextTooth(const Face& f, const Plane& plane, const Pose& pose) {
  const Vector axis{f.radius * std::tan(f.dish), 0, 0};
  const Vector inner{(f.radius - f.behind_from) * std::tan(f.dish), f.behind_from, 0};
  const Real turn = endOfFlank(f);
  const auto ofNext = [&](const Vector& place) {
    return inMachine(f, place, pose.tooth + (f.left_hand ? -turn : turn));
  };
  const Vector begin = ofNext(inner), corner = ofNext({0, f.radius, 0});
  const auto seen = [&](const Vector& place) { return std::array<Real, 2>{dot(place, pose.across), place[1]}; };
  const auto under = [&](const Vector& place) {
    const Vector turned = inMachine(f, plane.normal, pose.tooth);
    const Real off = dot(turned, less(place, inMachine(f, plane.through, pose.tooth)));
    return seen({place[0] - off / turned[0], place[1], place[2]});
  };
  return {{seen(begin), seen(corner)}, {under(begin), under(corner)}, under(axis)};
}

/// For a tooth whose edge goes to the axis, the rim is past the axis.
void judgeRimPastAxis(const Face& f, const Pose& pose, const Vector& face, const NextTooth& next, Real rim) {
  if (f.past_axis == 0) return;
  const Real off = std::hypot(next.at_axis[0] - dot(face, pose.across), next.at_axis[1] - face[1]);
  requireSame("rim past the axis", f.left_hand ? off - rim : rim - off, f.past_axis, kNear);
}

/// The inner edge of a cup's rim round the next tooth, of which all is within it by the gap.
void judgeRimRound(const Face& f, const Plane& plane, const Pose& pose, const Vector& face) {
  const Real inner = f.wheel_radius - f.rim - f.gap;
  const NextTooth next = nextTooth(f, plane, pose);
  Real farthest = 0;
  for (const auto& line : {next.edge, next.below}) {
    for (const auto& [u, v] : line) farthest = std::max(farthest, std::hypot(u - dot(face, pose.across), v - face[1]));
  }
  requireSame("farthest of the next tooth", farthest, inner, kNear);
  judgeRimPastAxis(f, pose, face, next, f.wheel_radius - f.rim);
}

/// A cup comes along X from where its face is clear of all of the blank's end.
void judgeWayIn(const Face& f, const Pose& pose, const Pass& pass) {
  requireSame("begin, Y", pass.from[1], pass.to[1], 0);
  requireSame("begin, Z", pass.from[2], pass.to[2], 0);
  const Real nearest = -f.stock * pose.spindle[0] + f.radius * std::abs(pose.spindle[2]);
  const Real clear = dot(pose.spindle, faceAt(f, pose, pass.from, pass.face_wear)) - nearest;
  require(clear >= f.clear - kExact && clear <= f.clear + 4 * f.radius * std::abs(pose.spindle[2]) + kExact,
          "distance from the blank", clear, f.clear);
}

/// The rim beside the next tooth: as seen along the spindle, neither its edge nor what is under it on the plane may be
/// nearer than the gap, and one of them is not farther.
void judgeRimOfEnd(const Face& f, const Plane& plane, const Pose& pose, const Vector& face, Real rim) {
  const NextTooth next = nextTooth(f, plane, pose);
  const Real u = dot(face, pose.across), v = face[1];
  requireSame("gap to the next tooth", std::min(nearest(u, v, next.edge), nearest(u, v, next.below)) - rim, f.gap,
              kNear);
  judgeRimPastAxis(f, pose, face, next, rim);
}

void judgeRimOfChamfer(const Face& f, const Plane& plane, const Pose& pose, const Vector& face, Real rim) {
  const Vector place = inMachine(f, plane.through, pose.tooth);
  requireSame("centre of the face, across", dot(face, pose.across), dot(place, pose.across));
  // Where the plane leaves the periphery at the end: of n1 cos + n2 sin = c, by the tangent of half the angle.
  const Real n1 = plane.normal[1] * f.radius, n2 = plane.normal[2] * f.radius, c = dot(plane.normal, plane.through);
  const Real half = (n2 + std::sqrt(std::max(Real(0), n1 * n1 + n2 * n2 - c * c))) / (c + n1);
  const Real leaves = 2 * std::atan(half);
  const Vector end = inMachine(f, {0, f.radius * std::cos(leaves), f.radius * std::sin(leaves)}, pose.tooth);
  const Vector corner = inMachine(f, {0, f.radius, 0}, pose.tooth);  // beyond it, a left-hand edge may fall to the end
  requireSame("rim below the chamfer", face[1] - rim, std::min({place[1], end[1], corner[1]}) - f.gap);
}

/// The rim on a gash's bottom, as seen along the spindle; from the axis, where the plane meets it.
void judgeGash(const Face& f, const Plane& plane, const Pose& pose, const Pass& pass, Real rim) {
  const Real level = dot(pose.spindle, inMachine(f, plane.through, pose.tooth)) / pose.spindle[2];
  const auto placeOf = [&](const Point& at) {
    const Vector face = faceAt(f, pose, at, pass.face_wear);
    const std::array<Real, 2> place{dot(less(face, {0, 0, level}), pose.across), face[1]};
    const Real above = (place[1] + f.past - pass.stock) * std::cos(f.angle) - place[0] * std::sin(f.angle);
    requireSame("rim above the gash's bottom", above, rim);
    return place;
  };
  requireSame("end along the gash", placeOf(pass.to)[0], -rim * std::sin(f.angle));
  const auto from = placeOf(pass.from);
  const Real off = std::hypot(std::max(-from[0], Real(0)), std::max(from[1] - f.radius, Real(0))) - rim;
  const Real clear = f.clear + f.stock;
  require(off >= clear - kExact && (pass.stock > kExact || off <= clear + kExact), "distance from the blank", off,
          clear);
}

}  // namespace

void judge(const Face& f, const Pass& pass) {
  const Plane plane = planeOf(f);
  const Pose pose = poseOf(f, plane);
  const Vector place = inMachine(f, plane.through, pose.tooth);
  const Real left = f.kind == Face::Kind::kGash ? 0 : pass.stock;
  const bool round = f.kind == Face::Kind::kEnd && f.left_hand;
  for (const Point* at : {&pass.from, &pass.to}) {
    requireSame("A", (*at)[3], f.a - pose.tooth);
    if (round && at == &pass.from) continue;
    requireSame("face above the plane", dot(pose.spindle, less(faceAt(f, pose, *at, pass.face_wear), place)), left);
  }
  const Real rim = f.wheel_radius - pass.wear;
  if (f.kind == Face::Kind::kGash) return judgeGash(f, plane, pose, pass, rim);
  // The passes step along X: the last one's place is where the rim is judged.
  Vector face = faceAt(f, pose, pass.to, pass.face_wear);
  face[0] += pass.stock / -pose.spindle[0];
  if (round) {
    judgeWayIn(f, pose, pass);
    return judgeRimRound(f, plane, pose, face);
  }
  requireSame("begin, X", pass.from[0], pass.to[0], 0);
  requireSame("begin, Y", pass.from[1], f.clear - pass.wear);
  requireSame("begin, Z", pass.from[2], pass.to[2], 0);
  f.kind == Face::Kind::kEnd ? judgeRimOfEnd(f, plane, pose, face, rim) : judgeRimOfChamfer(f, plane, pose, face, rim);
}

}  // namespace second_opinion
