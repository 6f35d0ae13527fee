#pragma once

#include <string>

namespace grinder {

/// Refuses what is no regular file, before it is opened: a FIFO would block its reader until somebody writes into it. A
/// link counts as what it leads to. All files that the package reads are let through here. Thread safe.
/// @throw JobFileError if there is none, or it is a folder, a FIFO or a device.
void requireRegularFile(const std::string& path);

/// Whether requireRegularFile() has let this file through in this process, by whatever name. Thread safe.
bool wasRead(const std::string& path);

}  // namespace grinder
