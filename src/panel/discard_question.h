#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/JobProgress.h"

#include <QLabel>
#include <QPushButton>
#include <QWidget>

namespace flute_grinder {

/// Whether starting a goal overwrites the journal's record of an unfinished job: another one, or the first part of the
/// same one.
bool discardsUnfinished(const GrindGoal& goal, const JobProgress& progress);

/// Asks whether to discard an unfinished job in favour of the one to be started.
class DiscardQuestion : public QWidget {
  Q_OBJECT

 public:
  explicit DiscardQuestion(QWidget* parent = nullptr);

  /// @param progress of the unfinished job.
  /// @param continuable whether the chosen file is that job, so that it can be continued.
  void ask(const JobProgress& progress, bool continuable);

 Q_SIGNALS:
  void discarded();
  void kept();  ///< or continued, if possible

 private:
  QLabel* text_;
  QPushButton* keep_;
};

}  // namespace flute_grinder
