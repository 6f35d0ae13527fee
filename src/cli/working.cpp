#include "cli/working.h"

#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace grinder {

bool isTerminal() {
  const char* type = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && type && *type && std::strcmp(type, "dumb") != 0;
}

std::size_t terminalWidth() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col - 1U : 79U;
}

Working::Working(const std::string& what) {
  if (!isTerminal()) return;
  const auto show = [text = escaped(what)](const std::string& time) {
    const std::size_t width = terminalWidth(), rest = std::strlen(" ...") + time.size();
    const std::string shown = text.substr(0, width - std::min(width, rest)) + " ..." + time;
    std::fprintf(stderr, "%s%s", kClearLine, shown.c_str());
  };
  show("");
  shows_ = std::thread([show, done = done_.get_future()] {
    for (int seconds = 1; done.wait_for(std::chrono::seconds(1)) == std::future_status::timeout; ++seconds) {
      show(format(" %d s", seconds));
    }
    std::fprintf(stderr, "%s", kClearLine);
  });
}

Working::~Working() {
  done_.set_value();
  if (shows_.joinable()) shows_.join();
}

}  // namespace grinder
