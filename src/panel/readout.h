#pragma once

#include "flute_grinder/client/grinder_client.h"
#include "flute_grinder/network/master_watch.h"

#include <QLabel>
#include <QProgressBar>
#include <QWidget>

#include <array>
#include <optional>

namespace grinder {

/// The panel's head: the grinder's name, its swivel, its state on a coloured field, and a sentence that explains the
/// state or says whether the grinder or the ROS master is missing.
class StateBox : public QWidget {
  Q_OBJECT

 public:
  explicit StateBox(QWidget* parent = nullptr);
  /// @param node resolved name of the grinder.
  void show(const GrinderView& view, const QString& node, Master master);

 private:
  void setNode(const QString& node);
  void setName(const QString& name, const QString& colour);

  QLabel* node_;
  QLabel* swivel_;
  QLabel* name_;
  QLabel* meaning_;
};

/// The progress of the stroke and of the job of any client, with the job's name.
class ProgressBox : public QWidget {
  Q_OBJECT

 public:
  explicit ProgressBox(QWidget* parent = nullptr);
  /// @param job_runs if false, the progress of planning is shown, or in grey the progress of the last job.
  void show(const GrinderView& view, bool job_runs);

 private:
  void showPlace(const GrinderView& view, const flute_grinder::GrindFeedback& feedback);
  void showPlanning(double planned);

  /// A bar with its text above it, legible whatever the bar's colours.
  struct Bar {
    QProgressBar* bar;
    QLabel* text;
  };

  static Bar makeBar(const char* name, const char* text_name);
  static void set(const Bar& bar, const QString& format, double fraction, bool enabled);

  QLabel* place_;
  QLabel* feed_;
  Bar stroke_, job_;
};

/// The work positions of the axes in mm and deg, with the distance to go of the running move. The tool tip has the
/// machine position and the work offset.
class PositionBox : public QWidget {
  Q_OBJECT

 public:
  explicit PositionBox(QWidget* parent = nullptr);
  void show(const GrinderView& view);
  /// Chooses the decimals. @param tolerance tolerance of the job shown [m]; nothing without a job.
  void setTolerance(std::optional<double> tolerance);

 private:
  std::array<QLabel*, kAxisCount> values_{};
  QLabel* to_go_title_;
  std::array<QLabel*, kAxisCount> to_go_{};
  int decimals_;
};

}  // namespace grinder
