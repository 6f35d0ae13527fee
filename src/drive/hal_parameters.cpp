#include "drive/hal_parameters.h"

#include "flute_grinder/drive/drive.h"

#include <cmath>

namespace grinder {

HalParameters readHalParameters(const ParameterReader& root, const ParameterReader& parameters) {
  // Half of the loop's history, because a stalled HAL may let a few cycles start while the FIFO is full.
  constexpr double most = kMaxCommandsWaiting / 2.0;
  HalParameters hal;
  const double rate = hal.control_rate = root.number("control_rate", 10, 20000);
  hal.buffer = static_cast<std::uint32_t>(std::lround(parameters.number("buffer", 2 / rate, most / rate) * rate));
  hal.streamer = parameters.whole("streamer", 0, 7);
  hal.component = parameters.text("component");
  return hal;
}

}  // namespace grinder
