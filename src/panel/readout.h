#pragma once

#include "flute_grinder/network/master_watch.h"
#include "panel/grinder_link.h"

#include <QLabel>
#include <QProgressBar>
#include <QWidget>

#include <array>
#include <optional>

namespace grinder {

/// The panel's head: the grinder's name, where its swivel stands, its state on a coloured field, and a sentence that
/// explains it, or that says whether the grinder or the ROS master is missing.
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

/// Progress of the stroke and of the job, which is named, whoever started it.
class ProgressBox : public QWidget {
  Q_OBJECT

 public:
  explicit ProgressBox(QWidget* parent = nullptr);
  /// @param job_runs if false, the last job's progress is shown in grey, or that of planning.
  void show(const GrinderView& view, bool job_runs);

 private:
  void showPlace(const GrinderView& view, const flute_grinder::GrindFeedback& feedback);
  void showPlanning(double planned);

  /// A bar with its text above it, where it is legible whatever the bar's colours.
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

/// Work position of the axes in mm and deg, with the distance to go of the running move; the machine's and the work
/// offset in the tool tip.
class PositionBox : public QWidget {
  Q_OBJECT

 public:
  explicit PositionBox(QWidget* parent = nullptr);
  void show(const GrinderView& view);
  /// Chooses the decimals. @param tolerance of the job that is shown [m]; nothing without one.
  void setTolerance(std::optional<double> tolerance);

 private:
  std::array<QLabel*, kAxisCount> values_{};
  QLabel* to_go_title_;
  std::array<QLabel*, kAxisCount> to_go_{};
  int decimals_;
};

}  // namespace grinder
