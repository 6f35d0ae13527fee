#pragma once

#include "flute_grinder/core/axes.h"

#include <hal.h>

#include <cstdint>

namespace flute_grinder {

/// The way into a HAL `streamer`: each servo cycle takes one command from it, and shows its number. Four floats and a
/// u32: `loadrt streamer cfg=ffffu`. One writer. Real-time but for the constructor.
class HalFifo {
 public:
  /// Attaches to the streamer.
  /// @param component the id of the HAL component.
  /// @param streamer its number, as in `streamer.0`.
  /// @param depth how many commands it must take at least.
  /// @throw ParameterError if there is no such streamer, or one of another type or depth.
  HalFifo(int component, int streamer, std::uint32_t depth);
  ~HalFifo();
  HalFifo(const HalFifo&) = delete;
  HalFifo& operator=(const HalFifo&) = delete;

  /// Appends a command. HAL keeps the last one back where their count is a multiple of the FIFO's depth (LinuxCNC 2.9),
  /// until another is there: while there is power, write one in each cycle.
  /// @param number that the streamer shows when it plays the command.
  /// @return false if there is no room.
  bool push(const Axes& command, std::uint32_t number);

  /// Throws away all that waits. Only while the streamer is not enabled, since it is the other reader.
  void drain();

 private:
  hal_stream_t stream_{};
};

}  // namespace flute_grinder
