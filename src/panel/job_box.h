#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/GrindResult.h"
#include "flute_grinder/GrinderState.h"
#include "flute_grinder/machine/offset_fit.h"
#include "flute_grinder/machine/swivel.h"
#include "flute_grinder/motion/work_offsets.h"
#include "panel/operation_choice.h"
#include "panel/question.h"

#include <QCheckBox>
#include <QFileDialog>
#include <QFileSystemWatcher>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPointer>
#include <QPushButton>
#include <QStackedWidget>
#include <QWidget>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

struct GrindJob;

/// The part of the panel where a job is chosen, planned and started. It emits a goal only if it was planned
/// without violations, and asks before an unfinished job is discarded, where wheel or zero points do not fit, and for
/// the swivel unless it is known to be set. A question shows what the job asks for beside what is set.
class JobBox : public QWidget {
  Q_OBJECT

 public:
  explicit JobBox(QWidget* parent = nullptr);

  const QString& file() const { return file_; }
  /// Selects and reads a file. @param file empty for none.
  void setFile(const QString& file);

  /// @param state nothing if the grinder does not answer.
  /// @param offsets nothing if they are not known.
  /// @param idle whether the grinder can plan now.
  void refresh(const std::optional<flute_grinder::GrinderState>& state,
               const std::optional<flute_grinder::WorkOffsets>& offsets, bool idle);

  /// Names the job that runs in the grinder where that is not the one from here. @param text empty for none.
  void showOtherJob(const QString& text);

  /// @param name resolved name of the grinder's node, whose robot description counts and which the dialogs name.
  void setGrinder(const std::string& name) { grinder_ = name; }

  /// Shows the result of a plan, if it is for the goal that would be started now.
  void setPlan(const flute_grinder::GrindGoal& goal, const flute_grinder::GrindResult& result);

  /// Plans the job once more, as it would be started now.
  void planAnew();

  /// The plan is no longer valid. @param why for the operator; empty if that is known.
  void discardPlan(const QString& why = "");

  /// Which operation of the file is chosen, for readJobFile(). @throw std::invalid_argument if it is still to be
  /// chosen.
  std::string operation() const;

  /// As read from the file; null if there is none, if it is wrong, or if its operation is not chosen. Another object
  /// after each reading.
  const std::shared_ptr<const GrindJob>& job() const { return job_; }

  bool planned() const { return planned_.has_value(); }
  /// Starts the planned goal, or asks first. A plan is good for one start: the next needs a plan from the axes' new
  /// position.
  void start();
  /// The grinder has taken the confirmation of swivelConfirmed(): starts the job.
  void startConfirmed();

 Q_SIGNALS:
  void fileChosen();
  /// start() has a question, or does not start the job: the text says what or why.
  void startDelayed();
  void planWanted(const flute_grinder::GrindGoal& goal);
  void startWanted(const flute_grinder::GrindGoal& goal);
  /// The operator has set the swivel for the job to be started. @param angle [rad].
  void swivelConfirmed(double angle);
  /// The operator has mounted the wheel of a goal, which is then to be planned anew.
  void wheelConfirmed(const flute_grinder::GrindGoal& goal);
  /// The work offsets that can be computed are to be fitted to a goal.
  void offsetFitWanted(const flute_grinder::GrindGoal& goal);

 private:
  void choose();
  void openSetup();
  void showFile();
  void read();
  void readAnew();
  void watchFiles();
  bool hasOtherZero(const flute_grinder::WorkOffsets& now) const;
  std::optional<flute_grinder::GrindGoal> takePlanned();
  void layOut();
  void makeQuestions();
  void ask(Question* question, const QString& text, const Comparison& figures = {});
  QString plannedJob() const;
  void closeQuestion() { pages_->setCurrentWidget(form_); }
  void askForWheel(bool discard);
  void askForOffsets();
  void askForSwivel();
  std::vector<OffsetMismatch> offsetMismatches() const;
  std::vector<OffsetMismatch> toAskFor(bool wheel) const;
  void showZeroPoints();
  bool asksWithReason() const;
  bool discardsSomething() const;
  std::optional<flute_grinder::GrindGoal> goalNow();
  std::optional<flute_grinder::GrindGoal> beginPlan();
  void refreshContinue(const std::optional<flute_grinder::GrinderState>& state);
  void findUnfinished();
  QString unfinishedName(const QString& rest) const;
  void clickContinue(bool checked);
  QString withoutPlan() const;
  void showVerdict(const QString& text, bool good);

  QString file_;
  std::string grinder_;  ///< name of its node
  std::shared_ptr<const GrindJob> job_;
  flute_grinder::GrindGoal goal_;                       ///< of that job, from its start
  std::optional<flute_grinder::GrindGoal> planned_;     ///< without violations
  flute_grinder::WorkOffsets planned_with_;             ///< the offsets of that plan
  std::optional<flute_grinder::GrindGoal> where_left_;  ///< the job as it would be continued, if it can be
  flute_grinder::JobProgress progress_;                 ///< as last received from the grinder
  std::string journal_error_;                           ///< the same; empty if the journal is good
  bool journal_damaged_ = false;                        ///< the same; the journal may then be discarded
  bool job_runs_ = false;                               ///< whose progress that is
  QString unfinished_file_;                            ///< of another job that can be continued; empty if none is known
  std::optional<OperationKind> unfinished_operation_;  ///< of that file, if it has several
  std::string sought_;                                 ///< the job and the chosen file for which that was sought
  Swivel swivel_;                                      ///< as last received from the grinder
  std::optional<WorkOffsets> offsets_;                 ///< as last received from the grinder
  bool discard_ = false;                               ///< the unfinished job, by the start that waits for an answer
  bool ignore_offset_check_ = false;                   ///< said for that start
  QLabel* name_;
  OperationChoice* operation_;
  QPushButton* choose_;
  QPushButton* setup_;
  QCheckBox* continue_;
  QLabel* zeros_;  ///< whether the zero points are the job's
  QPushButton* plan_;
  QPlainTextEdit* verdict_;
  QPlainTextEdit* other_job_;
  QStackedWidget* answer_;  ///< verdict, or the job of somebody else
  QWidget* form_;           ///< all of the above
  Question* discard_question_;
  QPushButton* keep_;
  Question* wheel_question_;
  Question* offset_question_;
  QPushButton* fit_;
  Question* swivel_question_;
  QStackedWidget* pages_;  ///< form or a question
  QPointer<QFileDialog> file_dialog_;
  QFileSystemWatcher watch_;  ///< of the job file and its wheel file
};

}  // namespace grinder
