#include "flute_grinder/job/format.h"

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/c_locale.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace grinder {

std::string format(const char* pattern, ...) {
  const CLocale with_points;
  va_list arguments, again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, pattern, arguments)), '\0');
  va_end(arguments);
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  return text;
}

double parseNumber(const char* text, char** end) {
  const CLocale with_points;
  return std::strtod(text, end);
}

bool hasForm(std::string_view text, std::string_view form) {
  return std::equal(text.begin(), text.end(), form.begin(), form.end(),
                    [](char c, char f) { return f == '0' ? c >= '0' && c <= '9' : c == f; });
}

std::string toolText(const CutterGeometry& cutter, std::size_t teeth) {
  return format("D %g mm, cone %g deg, spiral %g deg, rake %g deg, %zu %s", cutter.end_diameter / units::kMillimetre,
                cutter.cone_angle / units::kDegree, cutter.spiral_angle / units::kDegree,
                cutter.rake_angle / units::kDegree, teeth, teeth == 1 ? "tooth" : "teeth");
}

std::string jobText(const std::string& name, const std::string& operation, const CutterGeometry& cutter,
                    std::size_t teeth) {
  return (name.empty() ? "a job without a name" : name) + (operation.empty() ? "" : ", " + operation) + " (" +
         toolText(cutter, teeth) + ")";
}

}  // namespace grinder
