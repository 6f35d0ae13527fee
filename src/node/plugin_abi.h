#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace grinder {

/// The version of the drive interface that a plugin was built against (flute_grinder/drive/export_drive.h). Runs none
/// of its code.
/// @param library path of the plugin's library, which has been loaded.
/// @return nothing if the library itself states none, whatever those that it is linked with state.
std::optional<std::uint32_t> driveAbiOf(const std::string& library);

}  // namespace grinder
