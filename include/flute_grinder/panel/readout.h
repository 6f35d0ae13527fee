#pragma once

#include "flute_grinder/connection/master_watch.h"
#include "flute_grinder/panel/grinder_link.h"

#include <QLabel>
#include <QProgressBar>
#include <QWidget>

#include <array>

namespace flute_grinder {

/// The panel's head: the grinder's name, its state on a colour, and a sentence that says what that means, or who of
/// grinder and ROS master is missing.
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
  QLabel* name_;
  QLabel* meaning_;
};

/// How far the stroke and the job have come.
class ProgressBox : public QWidget {
  Q_OBJECT

 public:
  explicit ProgressBox(QWidget* parent = nullptr);
  /// @param job_runs else it is the last job's, and grey; or of a job that is being planned.
  void show(const GrinderView& view, bool job_runs);

 private:
  void showPlanning(double planned);

  QLabel* place_;
  QLabel* feed_;
  QProgressBar* stroke_;
  QProgressBar* job_;
};

/// Where the axes are, in mm and deg.
class PositionBox : public QWidget {
  Q_OBJECT

 public:
  explicit PositionBox(QWidget* parent = nullptr);
  void show(const GrinderView& view);

 private:
  std::array<QLabel*, kAxisCount> values_{};
};

}  // namespace flute_grinder
