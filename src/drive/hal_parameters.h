#pragma once

#include "flute_grinder/drive/parameters.h"

#include <cstdint>
#include <string>

namespace grinder {

/// The parameters of HalHardware.
struct HalParameters {
  std::string component;     ///< name of the HAL component
  int streamer = 0;          ///< number of the HAL streamer
  std::uint32_t buffer = 0;  ///< commands to keep in its FIFO
  double control_rate = 0;   ///< control rate of the machine [Hz]
};

/// @param root parameters of the machine. @param parameters parameters of the drive.
/// @throw ParameterError
HalParameters readHalParameters(const ParameterReader& root, const ParameterReader& parameters);

}  // namespace grinder
