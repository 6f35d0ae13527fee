#pragma once

#include "flute_grinder/GrindFeedback.h"

#include <mutex>
#include <string>

namespace grinder {

/// Shows the progress of a job on stderr. On a terminal it is a single line, redrawn and never wider than the terminal;
/// in a file, a pipe or on a dumb terminal it is one line per tenth of the job, or of its planning, and per state.
/// Thread safe.
class ProgressBar {
 public:
  /// @param teeth number of teeth of the job.
  /// @param passes number of passes of a tooth.
  ProgressBar(int teeth, int passes);
  /// Ends the line.
  ~ProgressBar();

  void show(const flute_grinder::GrindFeedback& feedback);

  /// Prints a separate line above the bar.
  void printLine(const std::string& text);

  /// Whether the end of the job is shown, or there was nothing to show beyond planning.
  bool complete();

  /// Ends the line; later feedback is not shown.
  void end();

 private:
  void draw();

  const bool terminal_;
  const int teeth_, passes_;
  std::mutex mutex_;
  bool begun_ = false, ended_ = false;
  int tenths_ = -1;
  flute_grinder::GrindFeedback last_;
};

}  // namespace grinder
