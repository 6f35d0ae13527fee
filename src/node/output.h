#pragma once

namespace grinder {

/// From now on, output that cannot be written at once is dropped, for instance after Ctrl-S in the terminal or with a
/// full pipe. Otherwise any thread that logs, roscpp's included, could block for ever.
void dropBlockedOutput();

}  // namespace grinder
