#include "panel/setup_dialog.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/machine/machine_model.h"
#include "flute_grinder/network/ros_api.h"
#include "flute_grinder/setup/job_setup.h"
#include "flute_grinder/setup/setup_sheet.h"
#include "flute_grinder/setup/touch_off.h"
#include "flute_grinder/setup/write_setup.h"
#include "panel/panel_button.h"
#include "panel/text_view.h"
#include "panel/wheel_guard.h"

#include <ros/names.h>
#include <QFontDatabase>
#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>

namespace grinder {

namespace {

constexpr int kPollInterval = 50;                     ///< interval of looks at the thread [ms]
constexpr int kSheetLines = 32, kSheetColumns = 105;  ///< size of the sheet with the buttons below it
constexpr int kFewestLines = 12;                      ///< least lines of the sheet with the question
constexpr int kWriteLines = 10;

/// The digests of all operations of a job file; none if they are not all set up.
std::vector<std::string> digestsOf(const std::string& file) {
  std::vector<std::string> digests;
  try {
    for (const GrindJob& job : readJobFile(file, "1").ofAllOperations()) digests.push_back(jobDigest(job));
  } catch (const FileError&) {
    // Such a file is no job's that was ever started.
  }
  return digests;
}

}  // namespace

SetupDialog::SetupDialog(const QString& file, const std::string& operation, const QString& title,
                         const std::string& grinder, QWidget* parent)
    : QDialog(parent),
      file_(file.toStdString()),
      operation_(operation),
      description_(ros::names::append(ros::names::parentNamespace(grinder), "robot_description")),
      flange_(ros::names::append(grinder, "geometry/flange")),
      sheet_(textView("setup_sheet", kFewestLines)),
      write_(new PanelButton("write_setup", "Write the set-up file", "Write the set-up file that the job file names")),
      why_not_(namedLabel("why_not_written")),
      question_(new Question("write", kWriteLines)),
      buttons_(makeButtons()) {
  setObjectName("setup_dialog");
  setWindowTitle("Set-up of " + title + " for " + QString::fromStdString(grinder));
  sheet_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(sheet_, 1);
  layout->addWidget(buttons_);
  layout->addWidget(question_);
  question_->setFixedHeight(question_->minimumSizeHint().height());
  showQuestion(false);
  resize(kSheetColumns * sheet_->fontMetrics().horizontalAdvance('0'),
         kSheetLines * sheet_->fontMetrics().lineSpacing());
  connect(write_, &QPushButton::clicked, this, &SetupDialog::ask);
  connect(question_, &Question::answered, this, [this] { showQuestion(false); });
  connect(&poll_timer_, &QTimer::timeout, this, &SetupDialog::poll);
  guardFromWheel(*this);
  beginToSolve();
  poll_timer_.start(kPollInterval);
}

SetupDialog::~SetupDialog() { stop_ = true; }

QWidget* SetupDialog::makeButtons() {
  write_->setEnabled(false);
  auto* close = new PanelButton("close_setup", "Close", "Close the sheet");
  close->setDefault(true);
  connect(close, &QPushButton::clicked, this, &QDialog::close);
  auto* buttons = new QWidget;
  auto* layout = new QHBoxLayout(buttons);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(why_not_, 1);
  layout->addWidget(write_);
  layout->addWidget(close);
  return buttons;
}

bool SetupDialog::isOfLastJob() const {
  const auto& digests = solved_.digests;
  return std::find(digests.begin(), digests.end(), last_.job_digest) != digests.end();
}

void SetupDialog::refresh(const flute_grinder::JobProgress& last, bool runs) {
  last_ = last;
  runs_ = runs;
  const bool in_use = runs && isOfLastJob();
  why_not_->setText(in_use ? "This job runs: its set-up file is not written." : "");
  write_->setEnabled(solved_.solved && !working_.valid() && !in_use);
  if (in_use) showQuestion(false);
}

void SetupDialog::ask() {
  QString text = "Write this set-up into " + QString::fromStdString(solved_.asked.setup_path) + "?\n" + solved_.changes;
  if (isOfLastJob() && !last_.finished) {
    text = "The job of this file is not finished, and cannot be continued with another set-up. " + text;
  }
  question_->ask(
      text, {}, {{"write_over", "Write it", "Replace the set-up of this operation", true, [this] { beginToWrite(); }}});
  showQuestion(true);
}

void SetupDialog::showQuestion(bool asks) {
  buttons_->setVisible(!asks);
  question_->setVisible(asks);
}

void SetupDialog::beginToWrite() {
  write_->setEnabled(false);
  working_ = std::async(std::launch::async,
                        [this, asked = solved_.asked, solved = solved_.solved] { return write(asked, *solved); });
}

void SetupDialog::beginToSolve() {
  write_->setEnabled(false);
  showText(*sheet_, "Solving ...", true);
  working_ = std::async(std::launch::async, [this] { return solve(); });
}

SetupDialog::Done SetupDialog::solve() const {
  const auto refused = [](const std::string& why) { return Done{nullptr, false, QString::fromStdString(why), false}; };
  try {
    const JobToSetUp asked = readJobToSetUp(file_, operation_);
    auto description = readParameter(description_, stop_);
    if (!description || description->getType() != XmlRpc::XmlRpcValue::TypeString) {
      return refused("the machine's swivel is not known: no parameter " + description_ + " from the ROS master");
    }
    const Range swivel = MachineModel(static_cast<std::string>(*description)).swivel();
    const auto result = solveJobSetup(asked.job, swivel, asked.wanted);
    if (const auto* refusal = std::get_if<std::string>(&result)) return refused(*refusal);
    const auto& setup = std::get<JobSetup>(result);
    const std::string refusal = planRefusal(setup);
    const std::string changes = changesText(asked.before, setup.job);
    const std::string sheet =
        "in the set-up\n" + changes + setupSheet(setup, swivel, aboveSwivel(asked, setup.job)) + refusal;
    if (!refusal.empty()) return refused(sheet + "It is not written.");
    Done done{nullptr, false, QString::fromStdString(sheet), true, digestsOf(file_), QString::fromStdString(changes),
              asked};
    if (asked.setup_path.empty()) {
      done.text += "The figures of the set-up are written by hand in the job file: no set-up file is written.\n";
    } else {
      done.solved = std::make_shared<const GrindJob>(setup.job);
    }
    return done;
  } catch (const std::exception& error) {
    return refused(error.what());
  }
}

std::optional<double> SetupDialog::aboveSwivel(const JobFile& asked, const GrindJob& job) const {
  auto flange = readParameter(flange_, stop_);
  const auto number = flange ? numberOf(*flange) : std::nullopt;
  if (!number) return std::nullopt;
  MachineGeometry machine;
  machine.flange = *number;
  return wheelAboveSwivel(asked.wheel, job, machine);
}

SetupDialog::Done SetupDialog::write(const JobToSetUp& asked, const GrindJob& solved) const {
  try {
    writeSetup(asked, solved);
    return {nullptr, true, "Written into " + QString::fromStdString(asked.setup_path) + ".", true};
  } catch (const std::exception& error) {
    return {nullptr, false, error.what(), false};
  }
}

void SetupDialog::poll() {
  if (working_.valid() && working_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    take(working_.get());
  }
  // A closed dialog stays until its thread has ended.
  if (!isVisible() && !working_.valid()) deleteLater();
}

void SetupDialog::take(const Done& done) {
  solved_ = done;
  refresh(last_, runs_);
  if (done.written) {
    sheet_->appendPlainText(done.text);
    Q_EMIT written();
  } else {
    showText(*sheet_, done.text, done.good);
  }
}

}  // namespace grinder
