#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/JobProgress.h"

#include <QLabel>
#include <QPushButton>
#include <QWidget>

namespace flute_grinder {

/// Whether a goal, when it begins, takes from the grinder's journal how far another job has come that is not finished,
/// or the same job's first part.
bool discardsUnfinished(const GrindGoal& goal, const JobProgress& progress);

/// Asks whether a job that is not finished is to be given up for the one that is to be started.
class DiscardQuestion : public QWidget {
  Q_OBJECT

 public:
  explicit DiscardQuestion(QWidget* parent = nullptr);

  /// @param progress of the job that is not finished.
  /// @param continuable whether the chosen file is that job's, so that it can be continued.
  void ask(const JobProgress& progress, bool continuable);

 Q_SIGNALS:
  void discarded();
  void kept();  ///< or to be continued, where it can be

 private:
  QLabel* text_;
  QPushButton* keep_;
};

}  // namespace flute_grinder
