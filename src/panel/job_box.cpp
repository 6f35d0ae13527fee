#include "panel/job_box.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
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

#include <cmath>
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
constexpr int kAnswerLines = 3;   ///< lines with room beside a choice of the operation; one more without
constexpr int kAngleDigits = 10;  ///< digits with which the angle appears as in the job file

bool isUnfinished(const flute_grinder::JobProgress& progress) {
  return !progress.job_digest.empty() && !progress.finished;
}

QString packageJobs() { return QString::fromStdString(ros::package::getPath("flute_grinder")) + "/jobs"; }

/// Whether starting a goal overwrites the journal's entry of an unfinished job: of another job, or of the first part of
/// the same job.
bool discardsUnfinished(const flute_grinder::GrindGoal& goal, const flute_grinder::JobProgress& progress) {
  if (!isUnfinished(progress)) return false;
  const bool goes_on = goal.first_tooth == progress.tooth && goal.first_pass == progress.pass;
  return !(goes_on && progress.job_digest == jobDigest(jobFromGoal(goal)));
}

/// Whether the operator must confirm the swivel before a goal is started. Never if the drive measures it: at
/// another angle the grinder refuses the goal.
bool needsConfirmation(const flute_grinder::GrindGoal& goal, const Swivel& swivel) {
  return !swivel.measured && !swivel.isAt(processOf(goal).setup_swivel);
}

/// A comparison of the values that a job asks for and the present ones.
Comparison comparisonOf(const std::vector<OffsetMismatch>& mismatches) {
  Comparison all{{"asked", "set", "off by"}, {}};
  for (const OffsetMismatch& mismatch : mismatches) {
    const std::string difference = mismatch.change ? text(Quantity{*mismatch.change, Unit::kMetre}) : "";
    QStringList row;
    for (const std::string& cell : {mismatch.what, mismatch.asked, mismatch.set, difference}) {
      row << QString::fromStdString(cell);
    }
    all.rows.push_back(row);
  }
  return all;
}

}  // namespace

JobBox::JobBox(QWidget* parent)
    : QWidget(parent),
      name_(new QLabel),
      operation_(new OperationChoice),
      choose_(new PanelButton("choose", "Open...", "Choose a job file")),
      setup_(new PanelButton("setup", "Set up...", "Find out how to set the wheel for the tool that the job asks for")),
      continue_(new QCheckBox(kContinue)),
      zeros_(new QLabel),
      plan_(new PanelButton("plan", "Plan",
                            "The grinder plans and checks the job as it would be ground; nothing moves. While a job "
                            "runs, 'grind plan' does so without the grinder")),
      verdict_(textView("verdict", kAnswerLines)),
      other_job_(textView("other_job", kAnswerLines)),
      answer_(new QStackedWidget),
      form_(new QWidget),
      discard_question_(new Question("unfinished", kQuestionLines)),
      wheel_question_(new Question("wheel", kQuestionLines)),
      offset_question_(new Question("offsets", kQuestionLines)),
      swivel_question_(new Question("swivel", kQuestionLines)),
      pages_(new QStackedWidget) {
  layOut();
  makeQuestions();
  connect(choose_, &QPushButton::clicked, this, &JobBox::choose);
  connect(setup_, &QPushButton::clicked, this, &JobBox::openSetup);
  connect(operation_, &OperationChoice::changed, this, &JobBox::readAnew);
  connect(continue_, &QCheckBox::clicked, this, &JobBox::clickContinue);
  connect(plan_, &QPushButton::clicked, this, &JobBox::planAnew);
  connect(&watch_, &QFileSystemWatcher::fileChanged, this, [this] {
    if (planned_) discardPlan(kFileChanged);
  });
  setFile("");
}

void JobBox::layOut() {
  name_->setObjectName("job_file");
  name_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  continue_->setObjectName("continue");
  zeros_->setObjectName("zero_points");
  zeros_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  zeros_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  zeros_->setFixedHeight(2 * zeros_->fontMetrics().lineSpacing() + 2);
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
  layout->addWidget(zeros_);
  answer_->addWidget(verdict_);
  answer_->addWidget(other_job_);
  layout->addWidget(answer_);
  pages_->addWidget(form_);
  auto* pages = new QVBoxLayout(this);
  pages->setContentsMargins(6, 6, 6, 6);
  pages->addWidget(pages_);
}

void JobBox::makeQuestions() {
  discard_question_->addDanger("discard", "Discard that job", "Start this job; the other cannot be continued any more",
                               0, 0, [this] { askForWheel(true); });
  keep_ = discard_question_->addAnswer("keep", "Continue it", "Plan the job from where it was left", 0, 1, [this] {
    if (!where_left_) return;
    continue_->setChecked(true);
    planAnew();
  });
  fit_ = offset_question_->addAnswer("fit_offsets", "",
                                     "Computed from what they were set for: the wheel and the swivel are the same. "
                                     "Plans the job again",
                                     0, 1, [this] {
                                       if (planned_) Q_EMIT offsetFitWanted(*planned_);
                                     });
  wheel_question_->addAnswer("confirm_wheel", "It is mounted",
                             "The wheel of the job is on the spindle. Plans the job again", 0, 1, [this] {
                               if (planned_) Q_EMIT wheelConfirmed(*planned_);
                             });
  offset_question_->addDanger("ignore_offset_check", "Ignore and grind",
                              "Start the job with the work offsets as they are", 1, 0, [this] {
                                ignore_offset_check_ = true;
                                askForSwivel();
                              });
  swivel_question_->addAnswer("confirm_swivel", "Confirm and start", "The swivel is set and clamped: start the job", 0,
                              1, [this] {
                                if (planned_) Q_EMIT swivelConfirmed(processOf(*planned_).setup_swivel);
                              });
  for (Question* question : {discard_question_, wheel_question_, offset_question_, swivel_question_}) {
    pages_->addWidget(question);
    connect(question, &Question::answered, this, &JobBox::closeQuestion);
  }
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
    showVerdict(folder.isEmpty() ? error.what() : QString(error.what()).remove(folder), false);
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
  showVerdict(why.isEmpty() ? withoutPlan() : why, why.isEmpty());
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
  if (goal) showVerdict("Planning ...", true);
  return goal;
}

void JobBox::setPlan(const flute_grinder::GrindGoal& goal, const flute_grinder::GrindResult& result) {
  if (goalNow() != goal) return;
  planned_.reset();
  if (result.plan.valid) planned_ = goal;
  planned_with_ = result.plan.offsets;
  showVerdict(QString::fromStdString(describe(result)), result.plan.valid != 0);
}

void JobBox::start() {
  if (!planned_) return;
  if (!discardsSomething()) return askForWheel(false);
  keep_->setVisible(where_left_.has_value());
  const std::string lost =
      journal_damaged_ ? journal_error_ + ". What job it kept is not known" : "Not finished: " + describe(progress_);
  ask(discard_question_,
      QString::fromStdString(lost + ". It cannot be continued once this one starts:") + "\n" + plannedJob());
}

bool JobBox::discardsSomething() const { return journal_damaged_ || discardsUnfinished(*planned_, progress_); }

/// A full description of the planned job.
QString JobBox::plannedJob() const {
  const std::string wheel = wheelText(basisOf(*planned_, OffsetMethod::kUnknown));
  return QString::fromStdString(describe(*planned_) + ", wheel " + wheel);
}

void JobBox::ask(Question* question, const QString& text, const Comparison& figures) {
  question->ask(text, figures);
  pages_->setCurrentWidget(question);
  Q_EMIT startDelayed();
}

void JobBox::askForWheel(bool discard) {
  discard_ = discard;
  ignore_offset_check_ = false;
  const auto wheels = toAskFor(true);
  if (wheels.empty()) return askForOffsets();
  ask(wheel_question_, plannedJob() + "\nIs its wheel on the spindle?", comparisonOf(wheels));
}

void JobBox::askForOffsets() {
  if (!planned_) return;
  const auto offsets = toAskFor(false);
  if (offsets.empty()) return askForSwivel();
  const QString axes = QString::fromStdString(computable(offsets));
  fit_->setText("Fit " + axes);
  fit_->setVisible(!axes.isEmpty());
  ask(offset_question_, plannedJob() + "\nThese zero points are not of this job:", comparisonOf(offsets));
}

/// The offsets, the wheel and the tool that do not fit the chosen job.
std::vector<OffsetMismatch> JobBox::offsetMismatches() const {
  if (!job_ || !offsets_) return {};
  return mismatches(*offsets_, goal_);
}

/// The mismatches to ask about; none for a job that is continued, which the grinder checks by itself.
/// @param wheel true for the wheel, false for all others.
std::vector<OffsetMismatch> JobBox::toAskFor(bool wheel) const {
  std::vector<OffsetMismatch> asked;
  if (continue_->isChecked()) return asked;
  for (OffsetMismatch& mismatch : offsetMismatches()) {
    if ((mismatch.what == "wheel") == wheel) asked.push_back(std::move(mismatch));
  }
  return asked;
}

void JobBox::askForSwivel() {
  if (!planned_ || !needsConfirmation(*planned_, swivel_)) return startConfirmed();
  const double asked = processOf(*planned_).setup_swivel;
  const bool known = std::isfinite(swivel_.angle);
  const auto shown = [](double angle) {
    return QString::fromStdString(text(Quantity{angle, Unit::kRadian}, kAngleDigits));
  };
  const QString set = known ? shown(swivel_.angle) : "not confirmed";
  const QString difference = known ? shown(asked - swivel_.angle) : "";
  ask(swivel_question_, plannedJob() + "\nIs the swivel set to " + shown(asked) + " and clamped?",
      {{"asked", "set", "off by"}, {{"swivel", shown(asked), set, difference}}});
}

void JobBox::startConfirmed() {
  closeQuestion();
  auto goal = takePlanned();
  if (!goal) {
    Q_EMIT startDelayed();
    return;
  }
  goal->discard = static_cast<std::uint8_t>(discard_);
  goal->ignore_offset_check = static_cast<std::uint8_t>(ignore_offset_check_);
  Q_EMIT startWanted(*goal);
}

void JobBox::planAnew() {
  if (const auto goal = beginPlan()) Q_EMIT planWanted(*goal);
}

/// The planned goal. Reads the file again; if it has changed since planning, shows the reason and returns nothing.
std::optional<flute_grinder::GrindGoal> JobBox::takePlanned() {
  read();
  auto goal = std::exchange(planned_, std::nullopt);
  if (goal && goal == goalNow()) return goal;
  if (job_) showVerdict(kFileChanged, false);
  return std::nullopt;
}

void JobBox::showOtherJob(const QString& text) {
  if (text != other_job_->toPlainText()) other_job_->setPlainText(text);
  answer_->setCurrentWidget(text.isEmpty() ? verdict_ : other_job_);
}

void JobBox::refresh(const std::optional<flute_grinder::GrinderState>& state,
                     const std::optional<flute_grinder::WorkOffsets>& offsets, bool idle) {
  offsets_.reset();
  if (offsets) offsets_ = fromMessage(*offsets);
  if (planned_ && offsets && hasOtherZero(*offsets)) discardPlan(kZeroChanged);
  showFile();
  showZeroPoints();
  if (state) swivel_ = {state->swivel, state->swivel_measured != 0};
  refreshContinue(state);
  for (auto* dialog : findChildren<SetupDialog*>()) dialog->refresh(progress_, job_runs_);
  if (!idle || !asksWithReason()) closeQuestion();
  choose_->setEnabled(idle);
  const bool chosen = !file_.isEmpty() && !operation_->isMissing();
  setup_->setEnabled(chosen);
  continue_->setEnabled(idle && (where_left_ || !unfinished_file_.isEmpty()));
  plan_->setEnabled(idle && chosen);
}

/// Whether the question shown still needs an answer.
bool JobBox::asksWithReason() const {
  if (!planned_) return false;
  if (pages_->currentWidget() == wheel_question_) return !toAskFor(true).empty();
  if (pages_->currentWidget() == offset_question_) return !toAskFor(false).empty();
  if (pages_->currentWidget() == swivel_question_) return needsConfirmation(*planned_, swivel_);
  return discardsSomething();
}

void JobBox::showZeroPoints() {
  QString text = "Zero points: not known";
  QString hint;
  if (offsets_) {
    QStringList axes, said;
    for (const OffsetMismatch& mismatch : offsetMismatches()) axes << QString::fromStdString(mismatch.what);
    if (continue_->isChecked()) said << "as when the job began";
    if (!axes.isEmpty()) said << "not of this job: " + axes.join(", ");
    if (said.isEmpty()) said << "set for this job";
    text = job_ ? "Zero points: " + said.join(";\n") : "Zero points";
    for (int axis = 0; axis < kAxisCount; ++axis) {
      const std::string basis = basisText(axis, offsets_->axes[static_cast<std::size_t>(axis)]);
      hint += QString(axisLetter(axis)) + ": " + QString::fromStdString(basis) + "\n";
    }
    hint += "Wheel: " + QString::fromStdString(mountedText(offsets_->wheel)) + "\n";
    hint += "Tool: " + QString::fromStdString(toolText(offsets_->tool));
  }
  if (text == zeros_->text() && hint == zeros_->toolTip()) return;
  zeros_->setText(text);
  zeros_->setToolTip(hint);
}

void JobBox::refreshContinue(const std::optional<flute_grinder::GrinderState>& state) {
  if (!state) return;
  const bool has_no_plan = verdict_->toPlainText() == withoutPlan();
  job_runs_ = isInJob(static_cast<MachineState>(state->state));
  progress_ = state->progress;
  journal_error_ = state->journal_error;
  journal_damaged_ = state->journal_damaged != 0;
  if (has_no_plan && verdict_->toPlainText() != withoutPlan()) showText(*verdict_, withoutPlan(), true);
  where_left_.reset();
  if (job_) {
    flute_grinder::GrindGoal left = goal_;
    if (continueFrom(progress_, *job_, left).empty()) where_left_ = left;
  }
  if (continue_->isChecked() && planned_ && planned_ != where_left_) discardPlan();
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
  return fontMetrics().elidedText(QFileInfo(unfinished_file_).fileName(), Qt::ElideMiddle, room) + all;
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

void JobBox::showVerdict(const QString& text, bool good) {
  showText(*verdict_, text, good);
  closeQuestion();
}

}  // namespace grinder
