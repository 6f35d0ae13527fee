#include "cli/goal.h"

#include "flute_grinder/messages/offset_basis.h"

#include <ros/serialization.h>

#include <unistd.h>

#include <cstdio>
#include <stdexcept>

namespace grinder {

int writeGoal(const std::string& job, const std::string& operation) {
  if (isatty(STDOUT_FILENO) != 0) {
    throw std::invalid_argument(
        "standard output is a terminal, and a goal is no text; allowed: a file or a pipe, as in "
        "'grind goal JOB > FILE'");
  }
  const ros::SerializedMessage goal = ros::serialization::serializeMessage(goalFromFile(job, operation));
  // Without the length, which a connection sends ahead.
  const std::size_t ahead = static_cast<std::size_t>(goal.message_start - goal.buf.get());
  std::fwrite(goal.message_start, 1, goal.num_bytes - ahead, stdout);
  return 0;
}

}  // namespace grinder
