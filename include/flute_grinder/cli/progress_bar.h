#pragma once

#include "flute_grinder/GrindFeedback.h"

#include <mutex>
#include <string>

namespace flute_grinder {

/// Shows on stderr how far a job has come. On a terminal that is one line, drawn anew and never longer than the
/// terminal is wide; in a file, a pipe or on a dumb terminal it is a line for each tenth of the job, or of
/// its planning, and each state. Thread safe.
class ProgressBar {
 public:
  /// @param teeth of the job.
  /// @param passes of a tooth.
  ProgressBar(int teeth, int passes);
  /// Ends the line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const GrindFeedback& feedback);

  /// Prints a line of its own, above the bar.
  void say(const std::string& text);

  /// Whether it stands at the end of the job, or there was no more to show than its planning.
  bool complete();

  /// Ends the line; what comes later is not shown.
  void end();

 private:
  void draw();

  const bool terminal_;
  const int teeth_, passes_;
  std::mutex mutex_;
  bool begun_ = false, ended_ = false;
  int tenths_ = -1;
  GrindFeedback last_;
};

}  // namespace flute_grinder
