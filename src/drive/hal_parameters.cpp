#include "drive/hal_parameters.h"

#include "flute_grinder/drive/drive.h"

#include <cmath>

namespace grinder {

HalParameters readHalParameters(const ParameterReader& root, const ParameterReader& parameters) {
  // Half of the loop's history, because a stalled HAL may let a few cycles start while the FIFO is full.
  constexpr double most = kMaxCommandsWaiting / 2.0;
  HalParameters hal;
  const double rate = hal.control_rate = root.number("control_rate", 10, 20000);
  hal.buffer = static_cast<std::uint32_t>(std::lround(
      parameters.number(
          "buffer", 2 / rate, most / rate,
          {"motion buffered in the streamer, which is how late the node may be; its FIFO must hold at least twice that",
           "s", nullptr, "2 to 2047.5 cycles; 0.002 to 2.0475 at 1000 Hz"}) *
      rate));
  hal.streamer = parameters.whole("streamer", 0, 7, {"number of the HAL streamer that plays the commands"});
  hal.component = parameters.text("component", "a text", {"name of the HAL component"});
  return hal;
}

}  // namespace grinder
