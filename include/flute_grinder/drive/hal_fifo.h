#pragma once

#include "flute_grinder/core/axes.h"

#include <hal.h>

#include <cstdint>

namespace flute_grinder {

/// The FIFO of a HAL `streamer`: each servo cycle takes one command out and shows its number. Four floats and a u32:
/// `loadrt streamer cfg=ffffu`. One writer. Real-time except for the constructor.
class HalFifo {
 public:
  /// Attaches to the streamer.
  /// @param component the id of the HAL component.
  /// @param streamer its number, as in `streamer.0`.
  /// @param depth how many commands it must hold at least.
  /// @throw ParameterError if there is no such streamer, or one of another type or depth.
  HalFifo(int component, int streamer, std::uint32_t depth);
  ~HalFifo();
  HalFifo(const HalFifo&) = delete;
  HalFifo& operator=(const HalFifo&) = delete;

  /// Appends a command. If their count is a multiple of the FIFO's depth, HAL withholds the last one until another
  /// follows (LinuxCNC 2.9): with power on, write one in each cycle.
  /// @param number that the streamer shows when it plays the command.
  /// @return false if there is no room.
  bool push(const Axes& command, std::uint32_t number);

  /// Discards queued commands. Only while the streamer is disabled, since it is the other reader.
  void drain();

 private:
  hal_stream_t stream_{};
};

}  // namespace flute_grinder
