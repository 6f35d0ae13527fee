#include "cli/time_text.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/record/record_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string_view>

namespace grinder {

std::string timeText(double time, bool utc) {
  const auto seconds = static_cast<std::time_t>(time);
  std::tm parts{};
  utc ? gmtime_r(&seconds, &parts) : localtime_r(&seconds, &parts);
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), utc ? "%Y-%m-%dT%H:%M:%SZ" : "%Y-%m-%d %H:%M:%S", &parts);
  return text.data();
}

double timeOfDate(const std::string& text, bool last) {
  const bool utc = !text.empty() && text.back() == 'Z';
  std::string whole = text.substr(0, text.size() - (utc ? 1 : 0));
  const auto forms = {"0000-00-00", "0000-00-00T00:00", "0000-00-00T00:00:00", "0000-00-00T00:00:00.000"};
  if (std::none_of(forms.begin(), forms.end(), [&](const char* form) { return hasForm(whole, form); })) {
    throw std::invalid_argument(
        text +
        "; allowed: YYYY-MM-DD, with Thh:mm, Thh:mm:ss or Thh:mm:ss.mmm after it for a time; Z at "
        "the end for UTC");
  }
  const std::string_view rest = last ? "T23:59:59.999" : "T00:00:00.000";
  whole += rest.substr(whole.size() - std::string_view("0000-00-00").size());
  const double time = timeOf(whole + "Z");
  if (utc) return time;
  const auto seconds = static_cast<std::time_t>(std::floor(time));
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  parts.tm_isdst = -1;
  return time - static_cast<double>(seconds) + static_cast<double>(std::mktime(&parts));
}

}  // namespace grinder
