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

/// The part of the panel where a job is chosen, planned and started. It emits a goal only if it was planned
/// without violations, and asks before an unfinished job is discarded.
class JobBox : public QGroupBox {
  Q_OBJECT

 public:
  explicit JobBox(QWidget* parent = nullptr);

  const QString& file() const { return file_; }
  /// Selects and reads a file. @param file empty for none.
  void setFile(const QString& file);

  /// @param state nothing if the grinder does not answer.
  /// @param idle whether the grinder can plan now.
  void refresh(const std::optional<GrinderState>& state, bool idle);

  /// Shows the result of a plan, if it is for the goal that would be started now.
  void setPlan(const GrindGoal& goal, const Plan::Response& plan);

  /// The plan is no longer valid.
  void discardPlan();

  bool planned() const { return planned_.has_value(); }
  /// Starts the planned goal, or asks first. A plan is good for one start: the next needs a plan from the axes' new
  /// position.
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
  std::optional<GrindJob> job_;          ///< from the file, if valid
  std::optional<GrindGoal> planned_;     ///< without violations
  std::optional<GrindGoal> where_left_;  ///< the job as it would be continued, if it can be
  JobProgress progress_;                 ///< as last received from the grinder
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
