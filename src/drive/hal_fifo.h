#pragma once

#include "flute_grinder/drive/drive.h"

#include <hal.h>

#include <cstdint>

namespace grinder {

/// The FIFO of a HAL `streamer`. Each servo cycle removes one command and outputs its number. A command is four floats
/// and a u32: `loadrt streamer cfg=ffffu`. Only one writer. Real-time except for the constructor.
class HalFifo {
 public:
  /// Attaches to the streamer.
  /// @param component id of the HAL component.
  /// @param streamer number of the streamer, as in `streamer.0`.
  /// @param depth minimum capacity in commands.
  /// @throw ParameterError if there is no such streamer, or if its type or depth is wrong.
  HalFifo(int component, int streamer, std::uint32_t depth);
  ~HalFifo();
  HalFifo(const HalFifo&) = delete;
  HalFifo& operator=(const HalFifo&) = delete;

  /// Appends a command. If the number of commands appended is a multiple of the FIFO's depth, HAL withholds the last
  /// one until another follows (LinuxCNC 2.9): with power on, write one in each cycle.
  /// @param number number that the streamer outputs when it plays the command.
  /// @return false if the FIFO is full.
  bool push(const AxisValues& command, std::uint32_t number);

  /// Discards queued commands. Call only while the streamer is disabled, because it also reads from the FIFO.
  void drain();

 private:
  hal_stream_t stream_{};
};

}  // namespace grinder
