#pragma once

#include <string>

namespace grinder {

/// Refuses everything but a regular file, before it is opened: a FIFO would block its reader until a writer opens it.
/// Links are followed. Every file that the package reads is checked here first. Thread safe.
/// @throw JobFileError if the file does not exist, or is a folder, a FIFO or a device.
void requireRegularFile(const std::string& path);

/// Whether requireRegularFile() has accepted this file in this process, by whatever name. Thread safe.
bool wasRead(const std::string& path);

}  // namespace grinder
