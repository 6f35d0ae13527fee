#include "flute_grinder/base/require.h"

#include "flute_grinder/base/format.h"

#include <stdexcept>
#include <string>

namespace grinder {

void require(bool good, const char* name, double value, const char* allowed, const char* unit) {
  if (good) return;
  std::string digits = format("%g", value);
  // With fewer digits a refused value might look like an allowed one.
  if (parseNumber(digits.c_str()) != value) digits = format("%.17g", value);
  throw std::invalid_argument(std::string(name) + " = " + digits + unit + "; allowed: " + allowed);
}

}  // namespace grinder
