#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/Plan.h"
#include "flute_grinder/core/grind_job.h"
#include "flute_grinder/panel/discard_question.h"

#include <QCheckBox>
#include <QGroupBox>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QStackedWidget>

#include <optional>

namespace flute_grinder {

/// The part of the panel where a job is chosen, planned and started. It gives a goal away only as it was planned
/// without a violation, and asks before a job is given up that was not finished.
class JobBox : public QGroupBox {
  Q_OBJECT

 public:
  explicit JobBox(QWidget* parent = nullptr);

  const QString& file() const { return file_; }
  /// Chooses a file and reads it. @param file empty for none.
  void setFile(const QString& file);

  /// @param state nothing where the grinder does not answer.
  /// @param idle whether the grinder has time for a plan.
  void refresh(const std::optional<GrinderState>& state, bool idle);

  /// Shows what came of a plan, if it is of the goal that would be started now.
  void setPlan(const GrindGoal& goal, const Plan::Response& plan);

  /// What was planned holds no more.
  void forgetPlan();

  bool planned() const { return planned_.has_value(); }
  /// Starts what was planned, or asks first. A plan is for one start: the next wants one from where the axes stand
  /// then.
  void start();

 Q_SIGNALS:
  void fileChosen();
  void planWanted(const flute_grinder::GrindGoal& goal);
  void dryRunWanted(const flute_grinder::GrindGoal& goal);
  void startWanted(const flute_grinder::GrindGoal& goal);

 private:
  void choose();
  void read();
  std::optional<GrindGoal> takePlanned();
  void startPlanned(bool discard);
  void keepUnfinished();
  GrindGoal goal() const;
  std::optional<GrindGoal> goalNow();
  std::optional<GrindGoal> beginPlan();
  void refreshContinue(const std::optional<GrinderState>& state);
  void showVerdict(const QString& text, bool good);

  QString file_;
  std::optional<GrindJob> job_;          ///< of the file, if that is good
  std::optional<GrindGoal> planned_;     ///< without a violation
  std::optional<GrindGoal> where_left_;  ///< the job as it would be continued, if it can be
  JobProgress progress_;                 ///< as the grinder told it last
  QLabel* name_;
  QPushButton* choose_;
  QCheckBox* continue_;
  QPushButton* plan_;
  QPushButton* dry_run_;
  QPlainTextEdit* verdict_;
  DiscardQuestion* question_;
  QStackedWidget* answer_;  ///< verdict or question
};

}  // namespace flute_grinder
