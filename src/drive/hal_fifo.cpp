#include "drive/hal_fifo.h"

#include "drive/hal_component.h"
#include "flute_grinder/drive/parameters.h"

#include <rtapi.h>

#include <array>
#include <cstring>
#include <string>

namespace grinder {

namespace {

constexpr int kStreamerKey = 0x48535430;  ///< key of streamer.0
constexpr const char* kTypes = "ffffu";
constexpr int kColumns = kAxisCount + 1;

}  // namespace

HalFifo::HalFifo(int component, int streamer, std::uint32_t depth) {
  const std::string name = "HAL's streamer." + std::to_string(streamer);
  const int key = kStreamerKey + streamer;
  const std::size_t size = requireHalMemory(key, name, std::string("load it: loadrt streamer cfg=") + kTypes);
  // Attached in full beforehand: hal_stream_attach() maps the memory in two steps and keeps the first address.
  const int memory = rtapi_shmem_new(key, component, size);
  if (memory < 0) throw ParameterError(name + " cannot be attached: " + std::strerror(-memory));
  const int attached = hal_stream_attach(&stream_, component, key, kTypes);
  // The library compares only as many types as the caller passes.
  if (attached < 0 || hal_stream_element_count(&stream_) != kColumns) {
    throw ParameterError(name + " has other columns; allowed: cfg=" + kTypes + " (X, Y, Z, A, number)");
  }
  const int deepest = hal_stream_maxdepth(&stream_);
  if (deepest < static_cast<int>(depth)) {
    throw ParameterError(name + " has depth=" + std::to_string(deepest) + "; allowed: " + std::to_string(depth) +
                         " or more for this buffer");
  }
}

HalFifo::~HalFifo() { hal_stream_detach(&stream_); }

bool HalFifo::push(const AxisValues& command, std::uint32_t number) {
  std::array<hal_stream_data, kColumns> sample;
  for (std::size_t i = 0; i < command.size(); ++i) sample[i].f = command[i];
  sample.back().u = number;
  return hal_stream_write(&stream_, sample.data()) >= 0;
}

void HalFifo::drain() {
  std::array<hal_stream_data, HAL_STREAM_MAX_PINS> sample;
  while (hal_stream_readable(&stream_)) hal_stream_read(&stream_, sample.data(), nullptr);
}

}  // namespace grinder
