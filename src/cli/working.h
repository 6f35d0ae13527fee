#pragma once

#include <cstddef>
#include <future>
#include <string>
#include <thread>

namespace grinder {

/// Whether stderr is a terminal on which a line can be drawn again.
bool isTerminal();

/// Usable columns: a character in the last one would wrap the cursor to a new line.
std::size_t terminalWidth();

/// Goes to the beginning of a terminal's line and clears it.
constexpr const char* kClearLine = "\r\x1b[K";

/// Says on stderr what the user waits for, and after a second for how long already; the line goes when the work is
/// done. Says nothing in a file, a pipe or on a dumb terminal.
class Working {
 public:
  /// @param what e.g. "drawing"; shown escaped, and cut to the terminal's width.
  explicit Working(const std::string& what);
  ~Working();

 private:
  std::promise<void> done_;
  std::thread shows_;
};

}  // namespace grinder
