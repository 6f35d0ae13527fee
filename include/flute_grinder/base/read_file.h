#pragma once

#include <cstddef>
#include <string>

namespace grinder {

constexpr std::size_t kMaxYamlFile = 65536;   ///< longest YAML file [bytes]
constexpr std::size_t kMaxUrdfFile = 262144;  ///< longest robot description [bytes]

/// Refuses everything but a regular file, before it is opened: a FIFO would block its reader until a writer opens it.
/// Links are followed. Every file that the package reads is checked here first. Thread safe.
/// @throw FileError if the file does not exist, or is a folder, a FIFO or a device.
void requireRegularFile(const std::string& path);

/// Whether requireRegularFile() has accepted this file in this process, by whatever name. Thread safe.
bool wasRead(const std::string& path);

/// The text of a file.
/// @param most maximum length [bytes].
/// @throw FileError with the cause if the file cannot be read, is empty or is longer.
std::string readTextFile(const std::string& path, std::size_t most = kMaxYamlFile);

}  // namespace grinder
