#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/time.h>

#include <optional>
#include <string>
#include <utility>

namespace grinder {

/// Watches whether the recorder of a bag is subscribed to the setpoints; reports in the log and on /diagnostics if it
/// has not been for some seconds. Not thread safe.
class RecorderWatch {
 public:
  /// @param recorder resolved name of the recorder's node; empty if none was asked for.
  explicit RecorderWatch(std::string recorder) : recorder_(std::move(recorder)) {}

  /// Registers the report with the updater, which this object must outlive, if a recorder was asked for.
  void addTo(diagnostic_updater::Updater& updater);

  /// A node has subscribed to the setpoints, or no longer does.
  void connect(const std::string& node) { connections_ += node == recorder_ ? 1 : 0; }
  void disconnect(const std::string& node) { connections_ -= node == recorder_ ? 1 : 0; }

  /// To be called regularly; logs what has changed.
  void look(ros::SteadyTime now);

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::string error() const;

  const std::string recorder_;
  int connections_ = 0;
  std::optional<ros::SteadyTime> gone_since_;
  bool is_missing_ = false;
};

}  // namespace grinder
