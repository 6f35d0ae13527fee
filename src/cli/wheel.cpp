#include "cli/wheel.h"

#include "cli/csv.h"
#include "cli/json_output.h"
#include "cli/time_text.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/replace_file.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/wheel_file.h"
#include "flute_grinder/network/user_at_host.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <system_error>

namespace grinder {

namespace {

using namespace units;

/// The maximum difference that does not count as a change of a size [m].
constexpr double kRounding = 1e-9;

/// A length in mm, to a picometre, so that rounding does not show.
std::string millimetres(double metres) {
  constexpr double per_millimetre = 1e9;
  return format("%.10g", std::round(metres / kMillimetre * per_millimetre) / per_millimetre + 0.0);
}

/// userAtHost(), without characters that have a meaning in YAML.
std::string whoami() {
  std::string name = userAtHost();
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) {
        return c >= 0x80 ||
               (std::isalnum(c) == 0 && std::string("@.-_").find(static_cast<char>(c)) == std::string::npos);
      },
      '_');
  return name;
}

void printWheel(const WheelFile& wheel) {
  const GrindProcess& p = wheel.process;
  const auto line = [](const char* name, const std::string& text) { std::printf("%-16s %s\n", name, text.c_str()); };
  line("profile", toString(p.wheel_profile));
  line("diameter", millimetres(wheel.diameter()) + " mm, Y = 0 is set to " + millimetres(p.wheel_diameter) +
                       " mm: wear " + millimetres(p.wheel_wear) + " mm");
  line("width", millimetres(p.wheel_width) + " mm, " + millimetres(wheel.new_width) + " mm when new");
  if (isTapered(p.wheel_profile)) {
    line("angle", format("%.10g deg", p.wheel_angle / kDegree) + ", larger face " + toString(p.wheel_side));
  }
  if (p.wheel_rim > 0) line("rim", millimetres(p.wheel_rim) + " mm wide");
  line("corner radii", millimetres(p.wheel_corner_radius_lower) + " mm lower, " +
                           millimetres(p.wheel_corner_radius_upper) + " mm upper");
  if (wheel.flange) line("flange", millimetres(*wheel.flange) + " mm from its face to the upper face");
  line("dressed", wheel.dressed.empty() ? "not known when" : wheel.dressed);
  line("measured", !wheel.measured ? "never" : wheel.date + (wheel.by.empty() ? "" : " by " + wheel.by));
}

Json toJson(const WheelFile& wheel) {
  const GrindProcess& p = wheel.process;
  const auto mm = [](double metres) { return parseNumber(millimetres(metres).c_str()); };
  Json points = Json::array();
  for (const ProfilePoint& point : wheel.process.wheel_points) points.push_back({mm(point.w), mm(point.radius)});
  const bool tapered = isTapered(p.wheel_profile);
  return {{"profile", toString(p.wheel_profile)},
          {"diameter_mm", mm(wheel.diameter())},
          {"set_diameter_mm", mm(p.wheel_diameter)},
          {"wear_mm", mm(p.wheel_wear)},
          {"width_mm", mm(p.wheel_width)},
          {"new_width_mm", mm(wheel.new_width)},
          {"angle_deg", tapered ? Json(p.wheel_angle / kDegree) : Json(nullptr)},
          {"side", tapered ? Json(toString(p.wheel_side)) : Json(nullptr)},
          {"rim_mm", p.wheel_rim > 0 ? Json(mm(p.wheel_rim)) : Json(nullptr)},
          {"corner_radius_mm", {mm(p.wheel_corner_radius_lower), mm(p.wheel_corner_radius_upper)}},
          {"points_mm", points.empty() ? Json(nullptr) : points},
          {"flange_mm", wheel.flange ? Json(mm(*wheel.flange)) : Json(nullptr)},
          {"dressed", wheel.dressed.empty() ? Json(nullptr) : Json(wheel.dressed)},
          {"measured", wheel.measured ? Json{{"date", wheel.date}, {"by", wheel.by}} : Json(nullptr)}};
}

/// Whether a measured size is plausible. Prints why if it is not.
bool isPlausible(const char* option, double measured, double before, bool force) {
  if (force || measured <= before + kRounding) return true;
  std::fprintf(stderr,
               "%s = %s mm; allowed: up to %s mm, as last known, unless --force says that this was wrong; a new wheel "
               "is a new file\n",
               option, millimetres(measured).c_str(), millimetres(before).c_str());
  return false;
}

/// A text of YAML with a key of its outermost map replaced, or added at the end.
/// @param item key and value, in whole lines.
std::string withItem(std::string text, const std::string& key, const std::string& item) {
  if (!text.empty() && text.back() != '\n') text += '\n';
  const std::string begin = "\n" + key + ":";
  const std::size_t found = ("\n" + text).find(begin);
  if (found == std::string::npos) return text + item;
  // The value's own lines are indented.
  std::size_t end = text.find('\n', found) + 1;
  while (text[end] == ' ') end = text.find('\n', end) + 1;
  return text.replace(found, end - found, item);
}

/// Writes the new sizes of a wheel into its file, if they are allowed.
/// @param old text of the file, from which `before` was read. @param dressed whether it was dressed, not only measured.
int update(const std::string& path, const std::string& old, const WheelFile& before, double diameter, double width,
           bool dressed) {
  const std::string date = timeText(static_cast<double>(std::time(nullptr)), true);
  const bool same_width = std::abs(width - before.process.wheel_width) <= kRounding;
  std::string measured = "measured:\n  date: " + date + "\n  diameter_mm: " + millimetres(diameter) + "\n";
  if (width != before.new_width) measured += "  width_mm: " + millimetres(width) + "\n";
  std::string text = withItem(old, "measured", measured + "  by: " + whoami() + "\n");
  if (dressed) text = withItem(text, "dressed", "dressed: " + date + "\n");
  try {
    const WheelFile after = parseWheel(text, path);
    replaceFile(path, text);
    printWheel(after);
  } catch (const FileError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  } catch (const std::system_error& error) {
    throw FileError(path + ": cannot be written: " + error.code().message());
  }
  if (!same_width) std::printf("The middle of the width has moved: set X and Z anew.\n");
  return 0;
}

}  // namespace

int showWheel(const WheelOptions& options) {
  const WheelFile wheel = readWheelFile(options.file);
  if (options.json) {
    print(toJson(wheel));
  } else {
    printWheel(wheel);
  }
  return 0;
}

int measureWheel(const WheelOptions& options) {
  const std::string text = readTextFile(options.file);
  const WheelFile wheel = parseWheel(text, options.file);
  const double diameter = options.diameter_mm * kMillimetre;
  const double width = options.width_mm ? *options.width_mm * kMillimetre : wheel.process.wheel_width;
  if (!isPlausible("--diameter", diameter, wheel.diameter(), options.force)) return 1;
  if (!isPlausible("--width", width, wheel.process.wheel_width, options.force)) return 1;
  return update(options.file, text, wheel, diameter, width, false);
}

int dressWheel(const WheelOptions& options) {
  const std::string text = readTextFile(options.file);
  const WheelFile wheel = parseWheel(text, options.file);
  const double radial = options.radial_mm.value_or(0) * kMillimetre;
  const double face = options.face_mm.value_or(0) * kMillimetre;
  if (!(radial > 0 || face > 0)) {
    std::fprintf(stderr, "nothing is dressed; allowed: --radial or --face more than 0 mm, or both\n");
    return 2;
  }
  return update(options.file, text, wheel, wheel.diameter() - 2 * radial, wheel.process.wheel_width - face, true);
}

}  // namespace grinder
