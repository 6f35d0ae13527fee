#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/z_correction.h"
#include "flute_grinder/job/cutter_geometry.h"
#include "flute_grinder/tool/ground_job.h"
#include "flute_grinder/tool/wheel_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

/// @file
/// The walls of a groove by trying: the wheel is tried at many places of the stroke and of its profile. Shares no code
/// with the sweep but the wheel's profile and the path.
namespace grinder::brute {

/// A cutter, and the wheel that grinds it.
struct Tool {
  CutterGeometry cutter;
  WheelProfile wheel = WheelProfile::straight(0.1, 0.003);
  double nominal_radius = 0;  ///< radius of the wheel that touches the small end at Y = 0 [m]
};

/// A cutter and a straight wheel, in the shop's units.
struct Shop {
  double diameter = 10, cone = 5, spiral = 30, rake = 8, length = 30, depth = 1.6, wheel = 100, width = 3;
  CutDirection cut = CutDirection::kRightHand;

  Tool tool() const {
    constexpr double kMm = units::kMillimetre, kDegree = units::kDegree;
    Tool tool;
    tool.cutter = {diameter * kMm, cone * kDegree, spiral * kDegree, rake * kDegree, length * kMm, cut};
    tool.wheel = WheelProfile::straight(wheel * kMm, width * kMm);
    tool.nominal_radius = wheel / 2 * kMm;
    return tool;
  }
};

/// A set-up of a wheel that grinds a cutter.
struct Bench {
  Tool tool;
  double swivel, height, depth;
  int poses = 120, places = 24;
  ZCorrection z_correction{};
  double x_shift = 0, taper = 0;  ///< of A's curve, and beside the cone

  /// Of the wheel's centre while it stands at s.
  double centreY(double s) const {
    return tool.cutter.end_diameter / 2 + tool.nominal_radius - depth + s * (std::tan(tool.cutter.cone_angle) + taper);
  }
  double centreZ(double s) const {
    const double z_per_y = rakeSide() * std::sin(tool.cutter.rake_angle);
    return height + s * std::tan(tool.cutter.cone_angle) * z_per_y + z_correction.at(s).z;
  }

  double radius(double x) const { return tool.cutter.end_diameter / 2 + x * std::tan(tool.cutter.cone_angle); }

  /// How far the path has turned at a place of the stroke.
  double turned(double s) const {
    const double tan_cone = std::tan(tool.cutter.cone_angle), tan_spiral = std::tan(tool.cutter.spiral_angle);
    const double r0 = tool.cutter.end_diameter / 2;
    return std::abs(tan_cone) < 1e-9 ? tan_spiral * s / r0 : tan_spiral / tan_cone * std::log(1 + s * tan_cone / r0);
  }

  struct End {
    double angle = -std::numeric_limits<double>::infinity(), w = 0;
  };

  /// The end of the circle's arc inside the wheel while it stands at s; side 1 is the upper end, -1 the lower one.
  End endAt(double x, double r, double s, int side) const {
    const double sn = std::sin(swivel), cs = std::cos(swivel), y0 = centreY(s), z0 = centreZ(s);
    const WheelProfile& wheel = tool.wheel;
    const double lower = wheel.lowerFace(), upper = wheel.upperFace();
    double sine = 0;
    const auto inside = [&](double w) {
      const double dz = (w + (x - s) * sn) / cs;
      sine = (z0 + dz) / r;
      if (!(std::abs(sine) <= 1)) return false;
      const double dy = r * std::sqrt(1 - sine * sine) - y0, t = dz * sn + (x - s) * cs;
      return dy * dy + t * t <= wheel.radius(w) * wheel.radius(w);
    };
    const auto place = [&](double i) {
      return side > 0 ? upper - (upper - lower) * i / places : lower + (upper - lower) * i / places;
    };
    for (int i = 0; i <= places; ++i) {
      if (!inside(place(i))) continue;
      double in = place(i);
      if (i > 0) {
        double out = place(i - 1);
        for (int k = 0; k < 36; ++k) {
          const double middle = (in + out) / 2;
          (inside(middle) ? in : out) = middle;
        }
      }
      inside(in);
      return {side * (std::asin(sine) + turned(s - x_shift)), in};
    }
    return {};
  }

  struct Way {
    double from, to;
  };

  /// Of the wheel's centre, while the wheel may reach a circle.
  Way way(double x, double r) const {
    const double large = tool.wheel.maxRadius(), rise = large * std::abs(std::tan(tool.cutter.cone_angle));
    const double reach = 1.1 * (rise + std::sqrt(rise * rise + 2 * large * std::max(depth, r - radius(0) + depth))) +
                         (tool.wheel.upperFace() - tool.wheel.lowerFace());
    Way way{x - 1.5 * reach, x + 1.5 * reach};
    const double apex = -tool.cutter.end_diameter / 2 / std::tan(tool.cutter.cone_angle);
    if (tool.cutter.cone_angle > 0) way.from = std::max(way.from, 0.98 * (apex + std::max(0.0, x_shift)));
    if (tool.cutter.cone_angle < 0) way.to = std::min(way.to, 0.98 * (apex + std::min(0.0, x_shift)));
    return way;
  }

  /// How deep a point of the cutter at A = 0 is in the wheel while that stands at s; negative beside it [m].
  double depthOf(double x, double r, double angle, double s) const {
    const double turn = angle - turned(s - x_shift);
    const double dx = x - s, dy = r * std::cos(turn) - centreY(s), dz = r * std::sin(turn) - centreZ(s);
    const double w = dz * std::cos(swivel) - dx * std::sin(swivel);
    const double lower = tool.wheel.lowerFace(), upper = tool.wheel.upperFace();
    const double from_spindle = std::sqrt(std::max(0.0, dx * dx + dy * dy + dz * dz - w * w));
    return std::min({tool.wheel.radius(std::clamp(w, lower, upper)) - from_spindle, w - lower, upper - w});
  }

  /// A wall on a circle, by its angle times the side, and the place of the profile that forms it.
  End wall(double x, double r, int side) const {
    const auto [from, to] = way(x, r);
    const double step = (to - from) / poses;
    std::vector<End> ends;
    for (int i = 0; i <= poses; ++i) ends.push_back(endAt(x, r, from + i * step, side));
    const auto angle = [&](int i) { return i < 0 || i > poses ? -1e9 : ends[static_cast<std::size_t>(i)].angle; };
    End best;
    for (int i = 0; i <= poses; ++i) {
      if (!std::isfinite(angle(i)) || angle(i) < angle(i - 1) || angle(i) < angle(i + 1)) continue;
      const End peak = highest(x, r, std::max(from, from + (i - 1) * step), std::min(to, from + (i + 1) * step), side);
      best = std::max({best, peak, ends[static_cast<std::size_t>(i)]},
                      [](const End& a, const End& b) { return a.angle < b.angle; });
    }
    return best;
  }

  /// By golden section between two poses.
  End highest(double x, double r, double a, double b, int side) const {
    End best;
    constexpr double kGolden = 0.6180339887498949;
    for (int k = 0; k < 40; ++k) {
      const double left = b - kGolden * (b - a), right = a + kGolden * (b - a);
      const End one = endAt(x, r, left, side), other = endAt(x, r, right, side);
      if (one.angle > best.angle) best = one;
      if (other.angle > best.angle) best = other;
      (one.angle > other.angle ? b : a) = one.angle > other.angle ? right : left;
    }
    return best;
  }

  /// The angle of the edge at X [rad].
  double edge(double x) const { return rakeSide() * wall(x, radius(x), rakeSide()).angle; }

  /// The minimum radius that the wheel reaches at X [m]. A disc of the wheel is a line across the section there, of
  /// which the near end counts, or its height where it passes the axis: the least over all discs and poses.
  double core(double x, const Way& way) const {
    const double sn = std::sin(swivel), cs = std::cos(swivel);
    const double lower = tool.wheel.lowerFace(), upper = tool.wheel.upperFace();
    double best = std::numeric_limits<double>::infinity(), best_s = x, best_w = lower;
    const auto look = [&](double pose, double disc) {
      const double s = std::clamp(pose, way.from, way.to), w = std::clamp(disc, lower, upper);
      const double dz = (w + (x - s) * sn) / cs, t = dz * sn + (x - s) * cs;
      const double squared = tool.wheel.radius(w) * tool.wheel.radius(w) - t * t;
      if (squared < 0) return;
      const double z = centreZ(s) + dz, y = centreY(s);
      const double r = std::hypot(z, std::max(0.0, y - std::sqrt(squared)));
      if (r < best) best = r, best_s = s, best_w = w;
    };
    double step = (way.to - way.from) / poses, disc = (upper - lower) / places;
    for (int i = 0; i <= poses; ++i) {
      for (int k = 0; k <= places; ++k) look(way.from + i * step, lower + k * disc);
    }
    for (int closer = 0; closer < 16; ++closer) {
      step /= 3, disc /= 3;
      for (double before = 2 * best; best < before;) {
        before = best;
        const double s = best_s, w = best_w;
        for (int i = -3; i <= 3; ++i) {
          for (int k = -3; k <= 3; ++k) look(s + i * step, w + k * disc);
        }
      }
    }
    return best;
  }

  double core(double x) const { return core(x, way(x, radius(x))); }

  int rakeSide() const { return tool.cutter.cut == CutDirection::kRightHand ? 1 : -1; }

  double rake(double x) const {
    const double r = radius(x), h = 1e-5 * r;
    return std::atan(r * (wall(x, r - h, rakeSide()).angle - wall(x, r + h, rakeSide()).angle) / (2 * h));
  }
};

/// Of a job's flutes, with the wheel as worn before them.
inline Bench benchOf(const GrindJob& job, int poses, int places, const ZCorrection& z_correction = {}) {
  const GrindProcess& p = job.process();
  return {{job.cutter, wheelOf(job).worn(p.wheel_wear), p.wheel_diameter / 2 - p.wheel_wear},
          p.setup_swivel,
          p.setup_height,
          p.depth,
          poses,
          places,
          z_correction,
          p.setup_x_shift,
          (p.depth - p.depthEnd()) / job.cutter.flute_length};
}

}  // namespace grinder::brute
