#pragma once

#include "flute_grinder/operator/grinder_link.h"

#include <QLabel>
#include <QProgressBar>
#include <QWidget>

#include <array>

namespace flute_grinder {

/// The state at the panel's head: its name on a colour, and a sentence that says what it means.
class StateBox : public QWidget {
  Q_OBJECT

 public:
  explicit StateBox(QWidget* parent = nullptr);
  void show(const GrinderView& view, const QString& node);

 private:
  void setName(const QString& name, const char* colour);

  QLabel* name_;
  QLabel* meaning_;
};

/// How far the stroke and the job have come.
class ProgressBox : public QWidget {
  Q_OBJECT

 public:
  explicit ProgressBox(QWidget* parent = nullptr);
  /// @param job_runs else it is the last job's, and grey.
  void show(const GrinderView& view, bool job_runs);

 private:
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
