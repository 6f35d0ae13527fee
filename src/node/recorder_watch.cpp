#include "node/recorder_watch.h"

#include <ros/console.h>

namespace grinder {

namespace {

/// Time for the recorder to start after the grinder, or for a shutdown that ends it first.
const ros::WallDuration kPatience(5);

}  // namespace

void RecorderWatch::addTo(diagnostic_updater::Updater& updater) {
  if (!recorder_.empty()) updater.add("Recorder", this, &RecorderWatch::report);
}

void RecorderWatch::look(ros::SteadyTime now) {
  if (recorder_.empty()) return;
  if (connections_ > 0) {
    if (is_missing_) ROS_WARN_STREAM("the recorder " << recorder_ << " takes the setpoints again");
    gone_since_.reset();
    is_missing_ = false;
    return;
  }
  if (!gone_since_) gone_since_ = now;
  if (is_missing_ || now - *gone_since_ <= kPatience) return;
  is_missing_ = true;
  ROS_ERROR_STREAM(error());
}

void RecorderWatch::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (is_missing_) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, error());
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, connections_ > 0 ? "recording" : "not yet there");
  }
}

std::string RecorderWatch::error() const {
  return "the recorder " + recorder_ + " takes no setpoints: no bag has what the grinder does";
}

}  // namespace grinder
