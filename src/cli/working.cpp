#include "cli/working.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace grinder {

bool isTerminal() {
  const char* type = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && type && *type && std::strcmp(type, "dumb") != 0;
}

Working::Working(std::string what) {
  if (!isTerminal()) return;
  std::fprintf(stderr, "%s%s ...", kClearLine, what.c_str());
  shows_ = std::thread([what = std::move(what), done = done_.get_future()] {
    for (int seconds = 1; done.wait_for(std::chrono::seconds(1)) == std::future_status::timeout; ++seconds) {
      std::fprintf(stderr, "%s%s ... %d s", kClearLine, what.c_str(), seconds);
    }
    std::fprintf(stderr, "%s", kClearLine);
  });
}

Working::~Working() {
  done_.set_value();
  if (shows_.joinable()) shows_.join();
}

}  // namespace grinder
