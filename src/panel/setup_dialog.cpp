#include "panel/setup_dialog.h"

#include "flute_grinder/control/swivel_range.h"
#include "flute_grinder/geometry/job_setup.h"
#include "flute_grinder/geometry/setup_file.h"
#include "flute_grinder/geometry/setup_sheet.h"
#include "flute_grinder/geometry/touch_off.h"
#include "flute_grinder/network/ros_api.h"
#include "panel/panel_button.h"
#include "panel/text_view.h"
#include "panel/wheel_guard.h"

#include <ros/master.h>
#include <ros/names.h>
#include <QFontDatabase>
#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include <chrono>
#include <exception>
#include <stdexcept>

namespace grinder {

namespace {

constexpr int kPollInterval = 50;  ///< [ms]
constexpr int kSheetLines = 24, kSheetColumns = 105;

}  // namespace

SetupDialog::SetupDialog(const QString& file, const std::string& operation, const QString& title,
                         const std::string& grinder, QWidget* parent)
    : QDialog(parent),
      file_(file.toStdString()),
      operation_(operation),
      description_(ros::names::append(ros::names::parentNamespace(grinder), "robot_description")),
      flange_(ros::names::append(grinder, "geometry/flange")),
      sheet_(textView("setup_sheet", kSheetLines)),
      keep_(new QComboBox),
      write_(new PanelButton("write_setup", "Write into the file",
                             "Write the set-up into the job file; all else in it stays as it is")) {
  setObjectName("setup_dialog");
  setWindowTitle("Set-up of " + title + " for " + QString::fromStdString(grinder));
  sheet_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  keep_->setObjectName("keep_figure");
  keep_->setToolTip("Leave this figure as it is in the job file");
  keep_->addItem("nothing");
  for (const auto& figure : kSetupFigures) keep_->addItem(figure.name);
  write_->setEnabled(false);
  auto* close = new PanelButton("close_setup", "Close", "Close the sheet");
  close->setDefault(true);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(new QLabel("Keep"));
  buttons->addWidget(keep_);
  buttons->addStretch(1);
  buttons->addWidget(write_);
  buttons->addWidget(close);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(sheet_, 1);
  layout->addLayout(buttons);
  resize(kSheetColumns * sheet_->fontMetrics().horizontalAdvance('0'), sizeHint().height());
  connect(close, &QPushButton::clicked, this, &QDialog::close);
  connect(keep_, QOverload<int>::of(&QComboBox::activated), this, &SetupDialog::beginToSolve);
  connect(write_, &QPushButton::clicked, this, [this] {
    keep_->setEnabled(false);
    write_->setEnabled(false);
    working_ = std::async(std::launch::async, [this, setup = setup_] { return write(*setup); });
  });
  connect(&poll_timer_, &QTimer::timeout, this, &SetupDialog::poll);
  guardFromWheel(*this);
  beginToSolve();
  poll_timer_.start(kPollInterval);
}

SetupDialog::~SetupDialog() { stop_ = true; }

void SetupDialog::beginToSolve() {
  keep_->setEnabled(false);
  write_->setEnabled(false);
  showText(*sheet_, "Solving ...", true);
  std::optional<SetupFigure> keep;
  const auto chosen = static_cast<std::size_t>(keep_->currentIndex());
  if (chosen > 0) keep = kSetupFigures[chosen - 1].value;
  working_ = std::async(std::launch::async, [this, keep] { return solve(keep); });
}

SetupDialog::Done SetupDialog::solve(std::optional<SetupFigure> keep) const {
  const auto refused = [](const std::string& why) { return Done{nullptr, false, QString::fromStdString(why), false}; };
  try {
    const GrindJob job = readJobFile(file_, unsolvedFields(keep), operation_);
    auto description = callRosApi(ros::master::getHost(), ros::master::getPort(), "getParam", {description_}, stop_);
    if (!description || description->getType() != XmlRpc::XmlRpcValue::TypeString) {
      return refused("the machine's swivel is not known: no parameter " + description_ + " from the ROS master");
    }
    const Range swivel = readSwivelRange(static_cast<std::string>(*description));
    const auto result = solveJobSetup(job, swivel, keep);
    if (const auto* refusal = std::get_if<std::string>(&result)) return refused(*refusal);
    const auto& setup = std::get<JobSetup>(result);
    const std::string refusal = planRefusal(setup);
    const std::string text = setupSheet(setup, swivel, aboveSwivel(setup.job)) + refusal;
    if (!refusal.empty()) return refused(text + "It is not written.");
    return {std::make_shared<const JobSetup>(setup), false, QString::fromStdString(text), true};
  } catch (const std::exception& error) {
    return refused(error.what());
  }
}

std::optional<double> SetupDialog::aboveSwivel(const GrindJob& job) const {
  auto flange = callRosApi(ros::master::getHost(), ros::master::getPort(), "getParam", {flange_}, stop_);
  if (!flange || flange->getType() != XmlRpc::XmlRpcValue::TypeDouble) return std::nullopt;
  MachineGeometry machine;
  machine.flange = static_cast<double>(*flange);
  return wheelAboveSwivel(file_, job, machine);
}

SetupDialog::Done SetupDialog::write(const JobSetup& setup) const {
  try {
    writeSetup(file_, setup);
    return {nullptr, true, "Written into " + QString::fromStdString(file_) + ".", true};
  } catch (const std::exception& error) {
    return {nullptr, false, error.what(), false};
  }
}

void SetupDialog::poll() {
  if (working_.valid() && working_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    take(working_.get());
  }
  // Closed, it stays until nothing is left to wait for.
  if (!isVisible() && !working_.valid()) deleteLater();
}

void SetupDialog::take(const Done& done) {
  setup_ = done.setup;
  keep_->setEnabled(true);
  write_->setEnabled(setup_ != nullptr);
  if (done.written) {
    sheet_->appendPlainText(done.text);
    Q_EMIT written();
  } else {
    showText(*sheet_, done.text, done.good);
  }
}

}  // namespace grinder
