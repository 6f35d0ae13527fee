#include "panel/job_box.h"

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/messages/continue_job.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/setup/job_setup.h"
#include "panel/beside.h"
#include "panel/panel_button.h"
#include "panel/plain_words.h"
#include "panel/setup_dialog.h"
#include "panel/text_view.h"

#include <ros/package.h>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QStringList>
#include <QVBoxLayout>

#include <exception>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr const char* kContinue = "Continue where it was left";
constexpr const char* kFileChanged = "A file of the job has changed since it was planned. Plan it again.";
constexpr const char* kZeroChanged = "A zero point or the wheel has changed since it was planned. Plan it again.";
constexpr int kTick = 30;  ///< width of a tick and its margins [px]
constexpr int kQuestionLines = 4;
constexpr int kAnswerLines = 3;  ///< lines with room beside a choice of the operation; one more without

bool isUnfinished(const flute_grinder::JobProgress& progress) {
  return !progress.job_digest.empty() && !progress.finished;
}

QString packageJobs() { return QString::fromStdString(ros::package::getPath("flute_grinder")) + "/jobs"; }

}  // namespace

JobBox::JobBox(QWidget* parent)
    : QWidget(parent),
      name_(namedLabel("job_file")),
      operation_(new OperationChoice),
      choose_(new PanelButton("choose", "Open...", "Choose a job file")),
      setup_(new PanelButton("setup", "Set up...", "Find out how to set the wheel for the tool that the job asks for")),
      continue_(new QCheckBox(kContinue)),
      plan_(new PanelButton("plan", "Plan",
                            "The grinder plans and checks the job as it would be ground; nothing moves. While a job "
                            "runs, 'grind plan' does so without the grinder")),
      report_(textView("plan_report", kAnswerLines)),
      other_job_(textView("other_job", kAnswerLines)),
      answer_(new QStackedWidget),
      form_(new QWidget),
      question_(new Question("job", kQuestionLines)),
      pages_(new QStackedWidget) {
  layOut();
  connect(choose_, &QPushButton::clicked, this, &JobBox::choose);
  connect(setup_, &QPushButton::clicked, this, &JobBox::openSetup);
  connect(operation_, &OperationChoice::changed, this, &JobBox::readAnew);
  connect(continue_, &QCheckBox::clicked, this, &JobBox::clickContinue);
  connect(plan_, &QPushButton::clicked, this, [this] { plan({}); });
  connect(question_, &Question::answered, this, &JobBox::closeQuestion);
  connect(&watch_, &QFileSystemWatcher::fileChanged, this, [this] {
    if (planned_) discardPlan(kFileChanged);
  });
  setFile("");
}

void JobBox::layOut() {
  name_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  continue_->setObjectName("continue");
  auto* file = new QHBoxLayout;
  file->addWidget(name_, 1);
  file->addWidget(choose_);
  file->addWidget(setup_);
  auto* layout = new QVBoxLayout(form_);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(file);
  layout->addWidget(operation_);
  layout->addWidget(continue_);
  layout->addWidget(plan_);
  answer_->addWidget(report_);
  answer_->addWidget(other_job_);
  layout->addWidget(answer_);
  pages_->addWidget(form_);
  pages_->addWidget(question_);
  auto* pages = new QVBoxLayout(this);
  pages->setContentsMargins(6, 6, 6, 6);
  pages->addWidget(pages_);
}

/// Opens the file dialog, which is not modal, so that the buttons that stop the grinder work meanwhile.
void JobBox::choose() {
  if (file_dialog_) {
    file_dialog_->raise();
    return file_dialog_->activateWindow();
  }
  const QString folder = file_.isEmpty() ? packageJobs() : QFileInfo(file_).path();
  file_dialog_ = new QFileDialog(this, "Choose a job file for " + QString::fromStdString(grinder_), folder,
                                 "Jobs (*.yaml *.yml);;All files (*)");
  // Qt's own dialog, read-only: the desktop's dialog is modal, and so are the messages of Qt's for writing.
  file_dialog_->setOption(QFileDialog::DontUseNativeDialog);
  file_dialog_->setOption(QFileDialog::ReadOnly);
  file_dialog_->setFileMode(QFileDialog::AnyFile);
  file_dialog_->setAttribute(Qt::WA_DeleteOnClose);
  connect(file_dialog_, &QFileDialog::fileSelected, this, [this](const QString& file) {
    setFile(file);
    Q_EMIT fileChosen();
  });
  moveBeside(*file_dialog_, *this);
  file_dialog_->show();
}

void JobBox::openSetup() {
  auto* dialog =
      new SetupDialog(file_, operation_->chosen(), operation_->named(QFileInfo(file_).fileName()), grinder_, this);
  connect(dialog, &SetupDialog::written, this, [this, file = file_] {
    if (file == file_) readAnew();
  });
  moveBeside(*dialog, *this);
  dialog->show();
}

void JobBox::setFile(const QString& file) {
  file_ = file;
  job_.reset();
  showFile();
  name_->setToolTip(file);
  operation_->offer({});
  readAnew();
}

/// Reads the file again, and looks again for a job to continue.
void JobBox::readAnew() {
  where_left_.reset();
  continue_->setChecked(false);
  discardPlan();
  if (!file_.isEmpty()) read();
  if (job_) discardPlan();
}

std::string JobBox::operation() const {
  if (operation_->isMissing()) throw std::invalid_argument("choose the operation of the job first");
  return operation_->chosen();
}

void JobBox::showFile() { showName(*name_, file_.isEmpty() ? "no job file" : QFileInfo(file_).fileName()); }

void JobBox::read() {
  const std::string file = file_.toStdString();
  try {
    // Works even for a file whose set-ups are still to be solved.
    operation_->offer(readJobToSetUp(file, "1").job.operations);
    if (operation_->isMissing()) {
      job_.reset();
      return discardPlan();
    }
    const JobFile opened = openJobFile(file, operation_->chosen());
    job_ = std::make_shared<const GrindJob>(opened.job);
    goal_ = goalFromFile(opened);
    watchFiles(opened);
  } catch (const std::exception& error) {
    job_.reset();
    planned_.reset();
    // Without the folder, which is too long for a panel.
    const QString folder = file_.chopped(QFileInfo(file_).fileName().size());
    showReport(folder.isEmpty() ? error.what() : QString(error.what()).remove(folder), false);
  }
}

/// Watches the files. To be repeated after each reading, because a replaced file is no longer watched.
void JobBox::watchFiles(const JobFile& opened) {
  for (const QString& file : watch_.files()) watch_.removePath(file);
  for (const std::string& file : {opened.path, opened.wheel_path, opened.setup_path}) {
    if (!file.empty()) watch_.addPath(QString::fromStdString(file));
  }
}

void JobBox::discardPlan(const QString& why) {
  planned_.reset();
  showReport(why.isEmpty() ? withoutPlan() : why, why.isEmpty());
}

/// Whether offsets from the grinder differ from the plan's. Older ones do not count: the offsets at the time of
/// planning may arrive after the plan.
bool JobBox::hasOtherZero(const flute_grinder::WorkOffsets& now) const {
  return now.header.stamp > planned_with_.header.stamp &&
         (now.values != planned_with_.values || now.wheel.mounting != planned_with_.wheel.mounting);
}

/// The text shown until a job is planned.
QString JobBox::withoutPlan() const {
  QString text = file_.isEmpty()           ? "Open a job file first."
                 : operation_->isMissing() ? "Choose the operation first."
                                           : "Not planned yet.";
  if (job_) text += "\n" + QString::fromStdString(toolText(job_->cutter, job_->tooth_angles.size())) + ".";
  if (!journal_error_.empty()) text += "\nThere is no journal: " + QString::fromStdString(journal_error_) + ".";
  if (!isUnfinished(progress_) || job_runs_) return text;
  return text +
         QString::fromStdString("\nNot finished: " + describe(progress_) + ". It ended: " + endText(progress_) + ".");
}

/// Opens the file of the unfinished job if another one is chosen.
void JobBox::clickContinue(bool checked) {
  if (!checked || where_left_) return discardPlan();
  setFile(unfinished_file_);
  if (unfinished_operation_) operation_->choose(*unfinished_operation_);
  readAnew();
  continue_->setChecked(true);
  Q_EMIT fileChosen();
}

std::optional<flute_grinder::GrindGoal> JobBox::goalNow() {
  if (!job_) return std::nullopt;
  if (continue_->isChecked()) return where_left_;
  return goal_;
}

std::optional<flute_grinder::GrindGoal> JobBox::beginPlan() {
  discardPlan();
  read();
  auto goal = goalNow();
  if (goal) showReport("Planning ...", true);
  return goal;
}

/// Whether a goal is the one that would be started now, whatever its answers.
bool JobBox::isForNow(flute_grinder::GrindGoal goal) {
  goal.answers.clear();
  return goalNow() == goal;
}

void JobBox::setPlan(const flute_grinder::GrindGoal& goal, const flute_grinder::GrindResult& result) {
  if (!isForNow(goal)) return;
  planned_.reset();
  if (result.plan.valid) planned_ = goal;
  needs_ = result.plan.needs;
  planned_with_ = result.plan.offsets;
  showReport(QString::fromStdString(describe(result)), result.plan.valid != 0);
}

void JobBox::start() {
  if (planned_) ask(*planned_, needs_);
}

void JobBox::ask(const flute_grinder::GrindGoal& goal, const std::vector<flute_grinder::Need>& needs) {
  planned_ = goal;
  needs_ = needs;
  answers_ = goal.answers;
  asked_ = 0;
  askNext();
}

/// Asks for the next of the needs; once all are answered, starts the job.
void JobBox::askNext() {
  if (!planned_) return;
  if (asked_ < needs_.size()) {
    question_->ask(needs_[asked_++], plannedJob(), [this](const flute_grinder::NeedAnswer& answer) { take(answer); });
    pages_->setCurrentWidget(question_);
    Q_EMIT startDelayed();
    return;
  }
  auto goal = takePlanned();
  if (!goal) {
    Q_EMIT startDelayed();
    return;
  }
  goal->answers = answers_;
  Q_EMIT startWanted(*goal);
}

void JobBox::take(const flute_grinder::NeedAnswer& answer) {
  answers_.push_back(answer.id);
  if (answer.changes_plan) return plan(answers_);
  askNext();
}

/// A full description of the planned job.
QString JobBox::plannedJob() const {
  const std::string wheel = wheelText(basisOf(*planned_, OffsetMethod::kUnknown));
  return QString::fromStdString(describe(*planned_) + ", wheel " + wheel);
}

/// Plans the job, as it would be started now. @param answers answers to the needs of the plan before.
void JobBox::plan(const std::vector<std::string>& answers) {
  auto goal = beginPlan();
  if (!goal) return;
  goal->answers = answers;
  Q_EMIT planWanted(*goal);
}

/// The planned goal. Reads the file again; if it has changed since planning, shows the reason and returns nothing.
std::optional<flute_grinder::GrindGoal> JobBox::takePlanned() {
  read();
  auto goal = std::exchange(planned_, std::nullopt);
  if (goal && isForNow(*goal)) return goal;
  if (job_) showReport(kFileChanged, false);
  return std::nullopt;
}

void JobBox::showOtherJob(const QString& text) {
  if (text != other_job_->toPlainText()) other_job_->setPlainText(text);
  answer_->setCurrentWidget(text.isEmpty() ? report_ : other_job_);
}

void JobBox::refresh(const std::optional<flute_grinder::GrinderState>& state,
                     const std::optional<flute_grinder::WorkOffsets>& offsets, bool idle) {
  if (planned_ && offsets && hasOtherZero(*offsets)) discardPlan(kZeroChanged);
  showFile();
  refreshContinue(state);
  for (auto* dialog : findChildren<SetupDialog*>()) dialog->refresh(progress_, job_runs_);
  if (!idle || !planned_) closeQuestion();
  choose_->setEnabled(idle);
  const bool chosen = !file_.isEmpty() && !operation_->isMissing();
  setup_->setEnabled(chosen);
  continue_->setEnabled(idle && (where_left_ || !unfinished_file_.isEmpty()));
  plan_->setEnabled(idle && chosen);
}

void JobBox::refreshContinue(const std::optional<flute_grinder::GrinderState>& state) {
  if (!state) return;
  const bool has_no_plan = report_->toPlainText() == withoutPlan();
  job_runs_ = isInJob(static_cast<MachineState>(state->state));
  progress_ = state->progress;
  journal_error_ = state->journal_error;
  if (has_no_plan && report_->toPlainText() != withoutPlan()) showText(*report_, withoutPlan(), true);
  where_left_.reset();
  if (job_) {
    flute_grinder::GrindGoal left = goal_;
    if (continueFrom(progress_, *job_, left).empty()) where_left_ = left;
  }
  if (continue_->isChecked() && planned_ && !isForNow(*planned_)) discardPlan();
  findUnfinished();
  if (!where_left_) continue_->setChecked(false);
  const QString place = QString(" at tooth %1, pass %2").arg(progress_.tooth + 1).arg(progress_.pass + 1);
  continue_->setText(where_left_                  ? "Continue" + place
                     : unfinished_file_.isEmpty() ? kContinue
                                                  : "Continue " + unfinishedName(place));
}

/// The name of the job that can be continued, with its file's name shortened to the room beside `rest`.
QString JobBox::unfinishedName(const QString& rest) const {
  const QString operation = unfinished_operation_ ? toString(*unfinished_operation_) : "";
  if (unfinished_file_ == file_) return operation + rest;
  const QString all = (operation.isEmpty() ? "" : ", " + operation) + rest;
  const int room = pages_->width() - kTick - fontMetrics().horizontalAdvance("Continue " + all);
  return nameFor(fontMetrics(), QFileInfo(unfinished_file_).fileName(), room) + all;
}

/// Finds the file of an unfinished job other than the chosen one, beside the chosen file or in the package.
void JobBox::findUnfinished() {
  if (where_left_ || job_runs_ || !isUnfinished(progress_)) {
    unfinished_file_.clear();
    sought_.clear();
    return;
  }
  // Files are read once for each unfinished job and each chosen file.
  const std::string sought = progress_.job_digest + file_.toStdString();
  if (std::exchange(sought_, sought) == sought) return;
  unfinished_file_.clear();
  for (const QString& folder : {QFileInfo(file_).path(), packageJobs()}) {
    const QString file = folder + "/" + QFileInfo(QString::fromStdString(progress_.job_name)).fileName();
    try {
      for (const GrindJob& one : readJobFile(file.toStdString(), "1").ofAllOperations()) {
        if (jobDigest(one) != progress_.job_digest) continue;
        unfinished_file_ = file;
        unfinished_operation_.reset();
        if (one.operations.size() > 1) unfinished_operation_ = one.process().kind;
        return;
      }
    } catch (const std::exception&) {
      // A file that cannot be read is not the job's.
    }
  }
}

void JobBox::showReport(const QString& text, bool good) {
  showText(*report_, text, good);
  closeQuestion();
}

}  // namespace grinder
