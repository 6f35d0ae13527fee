#include "record/ground_strokes.h"

#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

using units::kMillimetre;

constexpr double kNano = 1e-9;  ///< unit of the deviations, a hundredth of an encoder's resolution [m], [rad]

/// The keys of a deviation's parts. Only straight strokes have the last.
constexpr std::pair<const char*, double PathDeviation::*> kParts[]{{"y_nm", &PathDeviation::y},
                                                                   {"z_nm", &PathDeviation::z},
                                                                   {"a_nrad", &PathDeviation::a},
                                                                   {"x_nm", &PathDeviation::x}};

}  // namespace

Json toJson(const std::vector<RunStroke>& strokes) {
  Json list = Json::array();
  for (const RunStroke& stroke : strokes) {
    Json& json = list.emplace_back(Json{{"tooth", stroke.place.tooth + 1},
                                        {"pass", stroke.place.pass + 1},
                                        {"move", toString(stroke.move)},
                                        {"from_x_mm", stroke.range.from / kMillimetre},
                                        {"to_x_mm", stroke.range.to / kMillimetre}});
    for (const auto& [key, part] : kParts) {
      const auto is_off = [part = part](const PathDeviation& d) { return d.*part != 0; };
      const bool of_straight = std::any_of(stroke.deviations.begin(), stroke.deviations.end(), is_off);
      if (part == &PathDeviation::x && !of_straight) continue;
      Json& values = json[key] = Json::array();
      for (const PathDeviation& deviation : stroke.deviations) values.push_back(std::llround(deviation.*part / kNano));
    }
  }
  return list;
}

std::vector<RunStroke> runStrokesFrom(const Json& json) {
  std::vector<RunStroke> strokes;
  for (const Json& entry : json) {
    const auto move = valueOf<MoveKind>(entry.at("move").get<std::string>());
    if (!move) throw std::invalid_argument("move = " + text(entry["move"], -1) + "; allowed: " + namesOf<MoveKind>());
    RunStroke& stroke = strokes.emplace_back();
    stroke.place = {entry.at("tooth").get<int>() - 1, entry.at("pass").get<int>() - 1};
    stroke.move = *move;
    stroke.range = {entry.at("from_x_mm").get<double>() * kMillimetre, entry.at("to_x_mm").get<double>() * kMillimetre};
    stroke.deviations.resize(entry.at(kParts[0].first).size());
    for (const auto& [key, part] : kParts) {
      if (part == &PathDeviation::x && !entry.contains(key)) continue;
      for (std::size_t i = 0; i < stroke.deviations.size(); ++i) {
        stroke.deviations[i].*part = entry.at(key).at(i).get<double>() * kNano;
      }
    }
  }
  return strokes;
}

}  // namespace grinder
