#pragma once

#include "setup/flute_trial.h"

#include <array>

namespace grinder {

/// A set-up, and what tells it from others that grind the asked tool.
struct JudgedFlute {
  SetupPoint point;
  std::array<double, 2> overtravel{};  ///< at X = 0 and at the flute's end, for a complete flute [m]
  bool complete = false;               ///< whether the flute is then complete; not near a cone's apex
  bool cut_short = false;              ///< whether it is not complete, or only with a very long stroke
  bool is_facet = false;               ///< whether a facet at the edge has the rake, with another angle behind it
  double error = 0;                    ///< maximum error over the flute but of the chord, per tolerance
  double land = 0;                     ///< minimum land over the flute, per end diameter
  double chord = 0;                    ///< maximum error of the chordal rake, per tolerance
  double away = 0;                     ///< angle between swivel and spiral angle [rad], plus depth per radius
};

constexpr int kFluteSections = 8;  ///< intervals between the sections in which a flute is judged, as in a plan

/// @param point a set-up that gives a tool.
JudgedFlute judge(const FluteTrial& trial, const SetupPoint& point);

/// Whether one set-up is better than another: with a land, a complete flute, no facet, nearer to the asked values, then
/// shallower and with the swivel nearer to the spiral angle. Differences that cannot be measured on the tool do not
/// count.
bool isBetter(const JudgedFlute& a, const JudgedFlute& b);

}  // namespace grinder
