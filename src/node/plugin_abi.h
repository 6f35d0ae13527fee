#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace grinder {

/// The version of the drive interface that a plugin was built against (flute_grinder/drive/export_drive.h). Runs no
/// code of the plugin.
/// @param library path of the plugin's library, which has been loaded.
/// @return nothing if the library itself states no version, even if a library that it is linked with does.
std::optional<std::uint32_t> driveAbiOf(const std::string& library);

}  // namespace grinder
