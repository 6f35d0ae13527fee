#include "cli/time_text.h"

#include <array>
#include <ctime>

namespace grinder {

std::string timeText(double time, bool utc) {
  const auto seconds = static_cast<std::time_t>(time);
  std::tm parts{};
  utc ? gmtime_r(&seconds, &parts) : localtime_r(&seconds, &parts);
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), utc ? "%Y-%m-%dT%H:%M:%SZ" : "%Y-%m-%d %H:%M:%S", &parts);
  return text.data();
}

}  // namespace grinder
