#pragma once

#include <string>

namespace grinder {

/// Refuses what is no regular file, before it is opened: a FIFO would block its reader until somebody writes into it. A
/// link counts as what it leads to.
/// @throw JobFileError if there is none, or it is a folder, a FIFO or a device.
void requireRegularFile(const std::string& path);

}  // namespace grinder
