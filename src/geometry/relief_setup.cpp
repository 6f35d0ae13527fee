#include "geometry/relief_setup.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/quantity.h"
#include "geometry/relief_section.h"
#include "geometry/tooth_land.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace grinder {

namespace {

using units::kDegree;
using units::kMillimetre;

constexpr double kSameAngle = 1e-9;
constexpr double kSwivelStep = 1 * kDegree;
constexpr double kReachMargin = 0.2 * kMillimetre;  ///< of the rim beyond the relief's end, at least
constexpr double kNextEdgeMargin = 1 * kDegree;     ///< of the wheel from the next edge
constexpr double kLeastClearance = 0.5 * kDegree;   ///< at the land's end
constexpr double kAlongStep = 0.25 * kMillimetre;   ///< along the rim, while the land's end is looked for
constexpr double kWidest = 50 * kMillimetre;        ///< of a rim
constexpr int kSectionsOfFlute = 3;
constexpr int kPlacesOfWall = 12;  ///< between which a flute's wall is straight enough

std::string figure(double si, Unit unit) { return text(Quantity{si, unit}); }

/// The lands in some sections, of one tooth of those that are alike.
class Lands {
 public:
  struct Land {
    GroundSection section;
    std::size_t tooth;
    std::vector<double> wall;  ///< of the next flute at the heel, from the core to the edge's circle

    double heelWall(double r) const {
      const double part = (r - section.core_radius) / (section.radius - section.core_radius);
      const double at = std::clamp(part, 0.0, 1.0) * kPlacesOfWall;
      const auto i = std::min(static_cast<std::size_t>(at), wall.size() - 2);
      return wall[i] + (at - static_cast<double>(i)) * (wall[i + 1] - wall[i]);
    }
  };

  explicit Lands(const GroundCutter& cutter) : cutter_(cutter) {
    const double length = cutter.cutter().geometry().flute_length;
    for (int i = 0; i < kSectionsOfFlute; ++i) {
      const GroundSection section = cutter.section(length * i / (kSectionsOfFlute - 1));
      for (const std::size_t tooth : unlikeTeeth()) lands_.push_back(landOf(section, tooth));
    }
  }

  template <typename Visit>
  void visit(const Visit& visit) const {
    for (const Land& land : lands_) visit(land);
  }

  const GroundCutter& cutter() const { return cutter_; }

 private:
  std::vector<std::size_t> unlikeTeeth() const {
    const auto& teeth = cutter_.teeth();
    std::vector<std::tuple<std::size_t, std::size_t, double>> seen;
    std::vector<std::size_t> unlike;
    for (std::size_t i = 0; i < teeth.size(); ++i) {
      for (const std::size_t next : {(i + 1) % teeth.size(), (i + teeth.size() - 1) % teeth.size()}) {
        const double turn = std::remainder(teeth[next].angle - teeth[i].angle, units::kTurn);
        const auto tooth = std::make_tuple(teeth[i].flute, teeth[next].flute, std::round(turn / kSameAngle));
        if (std::find(seen.begin(), seen.end(), tooth) != seen.end()) continue;
        seen.push_back(tooth);
        if (unlike.empty() || unlike.back() != i) unlike.push_back(i);
      }
    }
    return unlike;
  }

  Land landOf(const GroundSection& section, std::size_t tooth) const {
    if (!section.teeth[tooth].edge) throw std::invalid_argument("no edge at X = " + figure(section.x, Unit::kMetre));
    const ToothLand land(cutter_, section, tooth);
    std::vector<double> wall;
    for (int i = 0; i <= kPlacesOfWall; ++i) {
      wall.push_back(land.heelWall(section.core_radius + (section.radius - section.core_radius) * i / kPlacesOfWall));
    }
    wall[0] = wall[1];  // the floor has no wall
    return {section, tooth, std::move(wall)};
  }

  const GroundCutter& cutter_;
  std::vector<Land> lands_;
};

/// How far along the rim a surface reaches up to where it ends, by the first place at which `over` is so.
/// @return infinity if it is so nowhere, or if the clearance is lost before.
template <typename Over>
double reachNeeded(const ReliefPath& path, double x, const Over& over) {
  for (double along = kAlongStep; along < kWidest; along += kAlongStep) {
    const ReliefPath::Place at = path.surface(x, along);
    if (!(at.clearance >= kLeastClearance)) break;
    if (over(at)) return along;
  }
  return std::numeric_limits<double>::infinity();
}

/// What a relief leaves of core and next teeth, and whether it is to be refused for that.
void judge(const Lands& lands, const Reliefs& relief, ReliefSetup& setup) {
  const CutterGeometry& c = lands.cutter().cutter().geometry();
  setup.next_edge = std::numeric_limits<double>::infinity();
  lands.visit([&](const Lands::Land& land) {
    const ReliefSection measured = measureRelief(lands.cutter(), land.section, land.tooth, relief);
    setup.next_edge = std::min(setup.next_edge, measured.next_edge);
    const double core = 2 * measured.core_radius, least = askedCore(c, land.section.x) - c.core_tolerance;
    if (core >= std::min(least, 2 * land.section.core_radius)) return;
    setup.refused = "the wheel leaves a core of " + figure(core, Unit::kMetre) +
                    " at X = " + figure(land.section.x, Unit::kMetre) + "; allowed: from " +
                    figure(least, Unit::kMetre);
  });
  if (setup.next_edge >= kNextEdgeMargin) return;
  setup.refused = setup.next_edge < 0
                      ? "the wheel reaches " + figure(-setup.next_edge, Unit::kRadian) + " beyond the next edge"
                      : "the wheel comes within " + figure(setup.next_edge, Unit::kRadian) + " of the next edge";
}

/// A swivel tried out.
ReliefSetup tried(const Lands& lands, const ReliefRequest& request, double swivel) {
  const ConicalCutter& cone = lands.cutter().cutter();
  ReliefSetup setup;
  setup.swivel = swivel;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  setup.land_end_clearance = {infinity, -infinity};
  ReliefWheel wheel = request.wheel;
  wheel.swivel = swivel;
  ReliefWheel wide = wheel;  // to find out how much of it is needed
  wide.width = 2 * kWidest;
  wide.height = ReliefPath::heightFor(cone, request.start, wide, 0);
  const ReliefPath path(cone, request.start, wide);
  lands.visit([&](const Lands::Land& land) {
    const ReliefPath::Place from = path.surface(land.section.x, 0);
    const auto wide_enough = [&](const ReliefPath::Place& at) {
      return std::hypot(at.radius * std::cos(at.behind - from.behind) - from.radius,
                        at.radius * std::sin(at.behind - from.behind)) >= request.land;
    };
    const auto at_heel = [&](const ReliefPath::Place& at) { return at.behind >= land.heelWall(at.radius); };
    const double reach =
        request.land > 0 ? reachNeeded(path, land.section.x, wide_enough) : reachNeeded(path, land.section.x, at_heel);
    setup.width = std::max(setup.width, reach);
    if (!(reach < kWidest)) return;
    const double end = path.surface(land.section.x, reach).clearance;
    setup.land_end_clearance = {std::min(setup.land_end_clearance.from, end),
                                std::max(setup.land_end_clearance.to, end)};
  });
  if (!(setup.width < kWidest)) {
    setup.refused = "the clearance is lost before the land's end";
    return setup;
  }
  setup.width += kReachMargin;
  if (setup.width > wheel.width) {
    setup.refused = "the relief needs a wheel " + figure(setup.width, Unit::kMetre) + " wide, this one is " +
                    figure(wheel.width, Unit::kMetre);
    return setup;
  }
  wheel.height = setup.height = ReliefPath::heightFor(cone, request.start, wheel, wheel.width / 2 - setup.width);
  const ReliefPath final_path(cone, request.start, wheel);
  judge(lands, {{reliefSweep(cone, final_path, wheel, request.edge)}}, setup);
  return setup;
}

ReliefSetup triedOrRefused(const Lands& lands, const ReliefRequest& request, double swivel) {
  try {
    return tried(lands, request, swivel);
  } catch (const std::invalid_argument& error) {
    ReliefSetup setup;
    setup.swivel = swivel;
    setup.refused = error.what();
    return setup;
  }
}

}  // namespace

WheelSweep reliefSweep(const ConicalCutter& cutter, const ReliefPath& path, const ReliefWheel& wheel, double edge) {
  GrindStroke stroke;
  stroke.from = path.lead() - path.beyondEnd();
  stroke.to = cutter.geometry().flute_length + path.lead() + path.beyondShank();
  stroke.y = path.y();
  stroke.y_per_x = path.taper();
  stroke.a = path.a() + edge;
  const double radius = wheel.nominal_radius - wheel.wear;
  return {path.cutter(),
          WheelProfile::straight(2 * radius, wheel.width, wheel.corner_radius),
          wheel.nominal_radius,
          {wheel.swivel, wheel.height, path.lead()},
          stroke};
}

ReliefSetup findReliefSetup(const GroundCutter& cutter, const ReliefRequest& request) {
  const Lands lands(cutter);
  if (request.asked) return triedOrRefused(lands, request, *request.asked);
  const ReliefSetup nearest =
      triedOrRefused(lands, request, std::clamp(request.near, request.swivel.from, request.swivel.to));
  if (nearest.refused.empty()) return nearest;
  const double farthest = std::max(request.near - request.swivel.from, request.swivel.to - request.near);
  for (double aside = kSwivelStep; aside <= farthest; aside += kSwivelStep) {
    for (const double swivel : {request.near + aside, request.near - aside}) {
      if (!(swivel >= request.swivel.from && swivel <= request.swivel.to)) continue;
      const ReliefSetup setup = triedOrRefused(lands, request, swivel);
      if (setup.refused.empty()) return setup;
    }
  }
  return nearest;
}

}  // namespace grinder
