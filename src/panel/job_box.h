#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/GrindResult.h"
#include "flute_grinder/GrinderState.h"
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
struct JobFile;

/// The part of the panel where a job is chosen, planned and started. It emits a goal only if it was planned
/// without violations, and asks first what the grinder says that the start needs.
class JobBox : public QWidget {
  Q_OBJECT

 public:
  explicit JobBox(QWidget* parent = nullptr);

  const QString& file() const { return file_; }
  /// Selects and reads a file. @param file empty for none.
  void setFile(const QString& file);

  /// @param state nothing if the grinder does not answer.
  /// @param offsets nothing if unknown.
  /// @param idle whether the grinder can plan now.
  void refresh(const std::optional<flute_grinder::GrinderState>& state,
               const std::optional<flute_grinder::WorkOffsets>& offsets, bool idle);

  /// Names the running job of another client. @param text empty for none.
  void showOtherJob(const QString& text);

  /// @param name resolved name of the grinder's node, for its robot description and for the dialogs.
  void setGrinder(const std::string& name) { grinder_ = name; }

  /// Shows the result of a plan, if it is for the goal that would be started now.
  void setPlan(const flute_grinder::GrindGoal& goal, const flute_grinder::GrindResult& result);

  /// Discards the plan. @param why reason for the operator; empty if he knows it.
  void discardPlan(const QString& why = "");

  /// The chosen operation of the file, for readJobFile(). @throw std::invalid_argument if none is chosen yet.
  std::string operation() const;

  /// The job read from the file; null without a file, with a wrong one, or if no operation is chosen. Each reading
  /// makes a new object.
  const std::shared_ptr<const GrindJob>& job() const { return job_; }

  bool planned() const { return planned_.has_value(); }
  /// Starts the planned goal, or asks first. A plan is good for one start: the next needs a plan from the axes' new
  /// position.
  void start();
  /// Asks for the answers that a goal still needs, and starts it then.
  void ask(const flute_grinder::GrindGoal& goal, const std::vector<flute_grinder::Need>& needs);

 Q_SIGNALS:
  void fileChosen();
  /// start() asks a question or does not start the job; the text shown says which.
  void startDelayed();
  void planWanted(const flute_grinder::GrindGoal& goal);
  void startWanted(const flute_grinder::GrindGoal& goal);

 private:
  void choose();
  void openSetup();
  void showFile();
  void read();
  void readAnew();
  void watchFiles(const JobFile& opened);
  bool hasOtherZero(const flute_grinder::WorkOffsets& now) const;
  std::optional<flute_grinder::GrindGoal> takePlanned();
  void layOut();
  QString plannedJob() const;
  void closeQuestion() { pages_->setCurrentWidget(form_); }
  void askNext();
  void take(const flute_grinder::NeedAnswer& answer);
  void plan(const std::vector<std::string>& answers);
  std::optional<flute_grinder::GrindGoal> goalNow();
  bool isForNow(flute_grinder::GrindGoal goal);
  std::optional<flute_grinder::GrindGoal> beginPlan();
  void refreshContinue(const std::optional<flute_grinder::GrinderState>& state);
  void findUnfinished();
  QString unfinishedName(const QString& rest) const;
  void clickContinue(bool checked);
  QString withoutPlan() const;
  void showReport(const QString& text, bool good);

  QString file_;
  std::string grinder_;  ///< name of the grinder's node
  std::shared_ptr<const GrindJob> job_;
  flute_grinder::GrindGoal goal_;                       ///< goal of job_, from its start
  std::optional<flute_grinder::GrindGoal> planned_;     ///< goal planned without violations
  std::vector<flute_grinder::Need> needs_;              ///< what the planned goal needs
  std::size_t asked_ = 0;                               ///< how many of them have been asked
  std::vector<std::string> answers_;                    ///< answers given to them
  flute_grinder::WorkOffsets planned_with_;             ///< work offsets of that plan
  std::optional<flute_grinder::GrindGoal> where_left_;  ///< goal that continues the job, if it can be continued
  flute_grinder::JobProgress progress_;                 ///< progress last received from the grinder
  std::string journal_error_;                           ///< error of the journal; empty if it is good
  bool job_runs_ = false;                               ///< the job of `progress_` is running
  QString unfinished_file_;                             ///< file of another job that can be continued; empty if unknown
  std::optional<OperationKind> unfinished_operation_;   ///< operation of that file, if it has several
  std::string sought_;                                  ///< job and chosen file for which that file was sought
  QLabel* name_;
  OperationChoice* operation_;
  QPushButton* choose_;
  QPushButton* setup_;
  QCheckBox* continue_;
  QPushButton* plan_;
  QPlainTextEdit* report_;
  QPlainTextEdit* other_job_;
  QStackedWidget* answer_;  ///< the plan report, or the job of another client
  QWidget* form_;           ///< page with all widgets above
  Question* question_;
  QStackedWidget* pages_;  ///< the form or the question
  QPointer<QFileDialog> file_dialog_;
  QFileSystemWatcher watch_;  ///< watches the job file and its wheel file
};

}  // namespace grinder
