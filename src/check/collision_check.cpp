#include "flute_grinder/check/collision_check.h"

#include "check/closest_search.h"
#include "flute_grinder/base/require.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

constexpr double kCentred = 1e-6;         ///< maximum offset from the wheel's axis of a shape that holds it [m]
constexpr double kContact = 1e-9;         ///< distance that counts as a contact, whatever is allowed [m]
constexpr double kRunOutMargin = 20e-6;   ///< margin above the errors of search and run-out together [m]
constexpr double kRunOutAccuracy = 1e-7;  ///< [m]

/// The frame of a body of revolution about a link's X.
Eigen::Isometry3d alongX() { return Eigen::Isometry3d(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitY())); }

Solid aboutX(const std::string& name, const std::vector<ProfilePoint>& rings) {
  Solid solid;
  solid.name = name;
  solid.rings = rings;
  solid.pose = alongX();
  return solid;
}

MachinePart fastened(MachinePart link, Solid solid) {
  solid.pose = link.solid.pose * solid.pose;
  link.solid = std::move(solid);
  return link;
}

CollisionCheck::Pair pairOf(const MachinePart& first, const MachinePart& second) {
  return {first.solid, second.solid, second.motion - first.motion};
}

CollisionCheck::Pair pairOf(const MachinePart& first, const MachinePart& second, double clearance) {
  CollisionCheck::Pair pair = pairOf(first, second);
  pair.below = std::max(clearance, kContact);
  return pair;
}

void requireFinite(const std::vector<Axes>& path) {
  const auto finite = [](const Axes& axes) { return axes.allFinite(); };
  if (path.empty() || !std::all_of(path.begin(), path.end(), finite)) {
    throw std::invalid_argument("path of the axes: empty or not finite; allowed: one or more finite points");
  }
}

bool canMeet(const MachinePart& a, const MachinePart& b) {
  return a.with_wheel != b.with_wheel && a.carrier != b.link && b.carrier != a.link;
}

}  // namespace

CollisionCheck::CollisionCheck(const MachineShapes& machine, const CollisionJob& job) : height_(job.setup.height) {
  require(std::isfinite(job.setup.swivel), "setup.swivel", job.setup.swivel, "finite");
  require(std::isfinite(job.setup.height), "setup.height", job.setup.height, "finite");
  require(job.nominal_radius > 0 && std::isfinite(job.nominal_radius), "nominal_radius", job.nominal_radius,
          "positive");
  require(job.stroke_end.allFinite(), "stroke_end X", job.stroke_end[kX], "a finite position of all axes");
  const double shank_from = job.shank_from.value_or(0);
  require(std::isfinite(shank_from), "shank_from", shank_from, "finite");
  require(job.clearance >= 0 && std::isfinite(job.clearance), "clearance", job.clearance, "0 or more");
  require(job.work_clearance >= 0 && std::isfinite(job.work_clearance), "work_clearance", job.work_clearance,
          "0 or more");
  require(job.shank_diameter > 0 && std::isfinite(job.shank_diameter), "shank_diameter", job.shank_diameter,
          "positive");
  require(std::isfinite(job.x_offset), "x_offset", job.x_offset, "finite");
  const double y_zero = job.cutter.end_diameter / 2 + job.nominal_radius;
  const Eigen::Matrix3d wheel_motion = machine.on("wheel", y_zero, job.setup.swivel).motion;
  std::vector<MachinePart> parts = machine.parts(y_zero, job.setup.swivel);
  for (MachinePart& part : parts) {
    part.solid.pose.pretranslate((part.motion - wheel_motion).col(kX) * job.x_offset);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      if (canMeet(parts[i], parts[k])) add(parts[i], parts[k]);
    }
  }
  addJob(machine, job, std::move(parts));
}

void CollisionCheck::addJob(const MachineShapes& machine, const CollisionJob& job, std::vector<MachinePart> parts) {
  const double y_zero = job.cutter.end_diameter / 2 + job.nominal_radius;
  const MachinePart cutter_link = machine.on(machine.chuck(), y_zero, job.setup.swivel);
  const MachinePart wheel_link = machine.on("wheel", y_zero, job.setup.swivel);
  const ConicalCutter cone(job.cutter);

  const double flute_end = job.cutter.flute_length;
  const double shank_radius = job.shank_diameter / 2;
  const Eigen::Isometry3d to_cutter = cutter_link.solid.pose.inverse();
  double holder = std::numeric_limits<double>::infinity();
  for (const MachinePart& part : parts) {
    if (!part.turns) continue;
    const Eigen::Vector3d outward = -cutter_link.solid.pose.linear().col(0);
    holder = std::min(holder, (to_cutter * part.solid.farthest(outward)).x());
  }
  if (!std::isfinite(holder)) {
    throw std::invalid_argument(
        "robot_description: nothing that turns with the cutter has a <collision> shape; allowed: what holds it");
  }
  const auto shank = [&](double from) {
    return fastened(cutter_link, aboutX("shank", {{from, shank_radius}, {std::max(from, holder), shank_radius}}));
  };

  const MachinePart wheel = fastened(wheel_link, Solid::wheel(job.wheel));
  const MachinePart cutter =
      fastened(cutter_link, aboutX("cutter", {{0, cone.radius(0)}, {flute_end, cone.radius(flute_end)}}));
  const MachinePart whole_shank = shank(job.shank_from.value_or(flute_end));
  for (const MachinePart& part : parts) {
    if (canMeet(part, wheel)) add(wheel, part);
    if (part.with_wheel) {
      const Eigen::Vector3d centre = wheel_link.solid.pose.inverse() * part.solid.pose.translation();
      const bool holds = part.link == wheel.link && centre.head<2>().norm() < kCentred;
      if (!holds) add(wheel, part);
      add(part, cutter);
      add(part, whole_shank);
    }
  }
  const double shank_from = job.shank_from ? *job.shank_from : runOutEnd(job);
  if (shank_from < holder) {
    pairs_.push_back(job.shank_from ? pairOf(wheel, shank(shank_from))
                                    : pairOf(wheel, shank(shank_from), job.clearance));
  }
  work_pairs_ = {pairOf(wheel, cutter, job.work_clearance), pairOf(wheel, whole_shank, job.work_clearance)};
}

void CollisionCheck::add(const MachinePart& first, const MachinePart& second) {
  pairs_.push_back(pairOf(first, second));
}

ClosestPlace CollisionCheck::closest(const std::vector<Axes>& path) const {
  requireFinite(path);
  ClosestSearch search(path, height_);
  for (const Pair& pair : pairs_) search.visit(pair);
  return search.best();
}

std::optional<ClosestPlace> CollisionCheck::tooCloseToWork(const std::vector<Axes>& path,
                                                           const std::vector<bool>& outside_cut) const {
  requireFinite(path);
  if (outside_cut.size() + 1 != path.size()) {
    throw std::invalid_argument("outside_cut: " + std::to_string(outside_cut.size()) + " legs; allowed: the path's, " +
                                std::to_string(path.size() - 1));
  }
  ClosestSearch search(path, height_, [&](std::size_t leg) { return outside_cut[leg]; });
  for (const Pair& pair : work_pairs_) search.visit(pair);
  if (search.best().distance < std::numeric_limits<double>::infinity()) return search.best();
  return std::nullopt;
}

double runOutEnd(const CollisionJob& job) {
  const ConicalCutter cone(job.cutter);
  const double end_radius = job.cutter.end_diameter / 2;
  const double x = job.stroke_end[kX];
  const double y = end_radius + job.nominal_radius + job.stroke_end[kY];
  const double depth = std::max(0.0, cone.radius(x) - (y - job.wheel.maxRadius()));
  const double radius = std::min(job.shank_diameter / 2, std::max(end_radius, cone.radius(x)) + depth);

  Solid wheel = Solid::wheel(job.wheel);
  wheel.pose = Eigen::Translation3d(x, y, job.setup.height + job.stroke_end[kZ]) *
               Eigen::AngleAxisd(-job.setup.swivel, Eigen::Vector3d::UnitY());
  const double reach =
      job.wheel.maxRadius() + job.wheel.upperFace() - job.wheel.lowerFace() + job.clearance + kRunOutMargin;
  double from = x, to = x + reach;
  while (to - from > kRunOutAccuracy) {
    const double middle = (from + to) / 2;
    const Gap space = gap(wheel, aboutX("shank", {{middle, radius}, {middle + reach, radius}}));
    (space.distance >= job.clearance + kRunOutMargin ? to : from) = middle;
  }
  return to;
}

}  // namespace grinder
