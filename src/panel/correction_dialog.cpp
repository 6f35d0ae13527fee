#include "panel/correction_dialog.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/client/requests.h"
#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/machine/need.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/network/ros_api.h"
#include "flute_grinder/network/user_at_host.h"
#include "flute_grinder/tool/z_law.h"
#include "panel/panel_button.h"
#include "panel/text_view.h"
#include "panel/wheel_guard.h"

#include <ros/names.h>
#include <QDateTime>
#include <QHBoxLayout>
#include <QVBoxLayout>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr int kLookInterval = 50;  ///< interval of looks at the thread [ms]
constexpr int kCorrectionLines = 6;
constexpr int kDialogWidth = 80;  ///< width of the dialog, in digits
constexpr int kFigureDecimals = 4;
constexpr double kSameOffset = 1e-9;  ///< [m]

/// A column of the table.
enum Column { kFigure, kAsked, kMeasured, kUnchanged, kCorrected };
constexpr std::pair<Column, const char*> kHeads[] = {{kFigure, "figure"},
                                                     {kAsked, "asked"},
                                                     {kMeasured, "measured"},
                                                     {kUnchanged, "next tool, unchanged"},
                                                     {kCorrected, "next tool, corrected"}};

XmlRpc::XmlRpcValue parameter(const std::string& name, const std::atomic<bool>& stop) {
  auto value = readParameter(name, stop);
  if (!value) throw std::runtime_error("no parameter " + name + " from the ROS master");
  return std::move(*value);
}

/// The folder of a grinder's records. @throw std::runtime_error if there is none on this computer.
std::string recordsOf(const std::string& grinder, const std::atomic<bool>& stop) {
  XmlRpc::XmlRpcValue value = parameter(ros::names::append(grinder, "history"), stop);
  const bool is_text = value.getType() == XmlRpc::XmlRpcValue::TypeString;
  const auto path = pathOf(is_text ? static_cast<std::string>(value) : "");
  if (!path) throw std::runtime_error("the grinder keeps no records");
  const std::string folder = pathOfNode(*path, grinder);
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return folder;
  throw std::runtime_error(folder + ": no records of this grinder on this computer");
}

Turns mostTurnsOf(const std::string& grinder, const std::atomic<bool>& stop) {
  Axes limit = Axes::Zero();
  for (const CorrectedAxis& one : kCorrectedAxes) {
    const std::string name = std::string("offset_change_limit/") + kJointNames[static_cast<std::size_t>(one.axis)];
    const auto number = numberOf(parameter(ros::names::append(grinder, name), stop));
    if (!number) throw std::runtime_error("parameter " + name + " is not a number");
    limit[one.axis] = *number;
  }
  return mostTurns(limit);
}

QString shown(double si, Unit unit) { return QString::fromStdString(fixed(si / shopScale(unit), kFigureDecimals)); }

/// @param utc text of utcText().
QString localTime(const std::string& utc) {
  return QDateTime::fromString(QString::fromStdString(utc), Qt::ISODateWithMs)
      .toLocalTime()
      .toString("yyyy-MM-dd HH:mm:ss");
}

/// A figure in words, e.g. "core diameter at X = 15 mm".
QString nameOf(const FigureAt& at) {
  return QString("%1 at X = %2 mm").arg(rowOf(at.figure).words).arg(at.x / units::kMillimetre);
}

}  // namespace

CorrectionDialog::CorrectionDialog(const QString& file, const std::string& operation, const QString& title,
                                   const std::string& grinder, QWidget* parent)
    : QDialog(parent),
      file_(file.toStdString()),
      operation_(operation),
      grinder_(grinder),
      tool_(namedLabel("measured_tool")),
      says_(namedLabel("correction")),
      keep_(new PanelButton("keep_measured", "Keep", "Keep what was measured in the record of this tool")),
      apply_(new PanelButton("apply_correction", "Correct...", "Set the work offsets of Y and Z; nothing moves")),
      back_(new PanelButton("correct_back", "Back...", "Set them to what they were before the last correction")),
      question_(new Question("correction", kCorrectionLines)),
      buttons_(new QWidget) {
  setObjectName("correction_dialog");
  setWindowTitle("Measured tools of " + title + " for " + QString::fromStdString(grinder));
  layOut();
  connect(keep_, &QPushButton::clicked, this, &CorrectionDialog::keep);
  connect(apply_, &QPushButton::clicked, this,
          [this] { ask(done_.found->last.offset + done_.correction.turn, "Correct the zero points?", present()); });
  connect(back_, &QPushButton::clicked, this, [this] { ask(*before_, "Set them back?", std::nullopt); });
  connect(question_, &Question::answered, this, [this] { showQuestion(false); });
  connect(&poll_timer_, &QTimer::timeout, this, &CorrectionDialog::poll);
  guardFromWheel(*this);
  begin({});
  poll_timer_.start(kLookInterval);
}

CorrectionDialog::~CorrectionDialog() { stop_ = true; }

void CorrectionDialog::layOut() {
  auto* close = new PanelButton("close_correction", "Close", "Close this window");
  connect(close, &QPushButton::clicked, this, &QDialog::close);
  auto* buttons = new QHBoxLayout(buttons_);
  buttons->setContentsMargins(0, 0, 0, 0);
  buttons->addStretch(1);
  for (QPushButton* button : {keep_, apply_, back_, static_cast<QPushButton*>(close)}) buttons->addWidget(button);
  for (QLabel* label : {tool_, says_}) label->setWordWrap(true);
  says_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(tool_);
  layout->addWidget(says_, 1, Qt::AlignTop);
  layout->addWidget(buttons_);
  layout->addWidget(question_);
  question_->setFixedHeight(question_->minimumSizeHint().height());
  showQuestion(false);
  resize(kDialogWidth * fontMetrics().horizontalAdvance('0'), minimumSizeHint().height());
  for (QPushButton* button : {keep_, apply_, back_}) button->setEnabled(false);
}

void CorrectionDialog::begin(std::vector<MeasuredFigure> figures) {
  says_->setText("Reading the records ...");
  if (table_ != nullptr) table_->setEnabled(false);
  // What has been entered stays that of its tool, whatever has been ground since.
  const std::uint64_t tool = entered().empty() ? 0 : done_.tool.number;
  working_ = std::async(std::launch::async, [this, figures = std::move(figures), tool] { return work(figures, tool); });
}

CorrectionDialog::Done CorrectionDialog::work(const std::vector<MeasuredFigure>& figures, std::uint64_t tool) const {
  Done done;
  try {
    const ValidJob job(readJobFile(file_, operation_));
    done.basis = basisOf(goalFromFile(file_, operation_), OffsetMethod::kCorrection);
    const std::vector<ToolNumber> tools = toolsIn(recordsOf(grinder_, stop_), jobDigest(*job));
    done.tool = toolOf(tools, tool);
    if (!figures.empty()) {
      keepMeasured(done.tool, figures, userAtHost());
      done.kept = true;
      done.tool = toolOf(tools, 0);
    }
    done.found = findingsOf(withLaws(job), tools, 0);
    const bool known = done.found->isKnown();
    done.correction = done.found->correction(known ? mostTurnsOf(grinder_, stop_) : Turns(Turns::Zero()));
    done.good = !done.found->alarm;
    for (const std::string& one : done.found->left_out) done.text += QString::fromStdString(one) + "\n";
    done.text += QString::fromStdString(settingsText(*done.found, done.correction));
  } catch (const std::exception& error) {
    done.found.reset();
    done.text = error.what();
  }
  return done;
}

void CorrectionDialog::poll() {
  if (working_.valid() && working_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    take(working_.get());
  }
  // A closed dialog stays until its thread has ended.
  if (!isVisible() && !working_.valid()) deleteLater();
}

void CorrectionDialog::take(Done done) {
  showText((done.kept && !done.found ? "Kept. " : "") + done.text, done.good);
  if (table_ != nullptr) table_->setEnabled(true);
  // What was shown stays, with what has been typed and not kept, if nothing could be read.
  failed_ = !done.found;
  if (failed_ && done.kept && done_.found) showTable({});
  if (failed_) return;
  const auto stays = done.kept ? std::map<std::string, QString>() : entered();
  done_ = std::move(done);
  const MeasuredTool& last = done_.found->last;
  tool_->setText(done_.tool.number == last.number
                     ? QString("Tool %1, the last of this job and set-up, ground until %2. Enter what a gauge says of "
                               "its first tooth.")
                           .arg(last.number)
                           .arg(localTime(last.ended))
                     : QString("Tool %1, of which figures are entered. Tool %2 has been ground since: keep or delete "
                               "them first.")
                           .arg(done_.tool.number)
                           .arg(last.number));
  showTable(stays);
}

/// What has been typed and not kept, by the texts of the figures.
std::map<std::string, QString> CorrectionDialog::entered() const {
  std::map<std::string, QString> all;
  for (const Row& row : rows_) {
    const QString typed = row.measured->text().trimmed();
    if (!typed.isEmpty()) all[text(row.at)] = typed;
  }
  return all;
}

void CorrectionDialog::showTable(const std::map<std::string, QString>& entered) {
  delete table_;
  rows_.clear();
  table_ = new QWidget;
  auto* grid = new QGridLayout(table_);
  grid->setContentsMargins(0, 0, 0, 0);
  for (const auto& [column, head] : kHeads) {
    auto* label = new QLabel(head);
    QFont bold = label->font();
    bold.setBold(true);
    label->setFont(bold);
    grid->addWidget(label, 0, column);
  }
  const bool known = done_.found->isKnown();
  const MeasuredTool& last = done_.found->last;
  for (const CorrectedFigure& figure : correctedFigures(done_.found->model, done_.correction)) {
    const int row = grid->rowCount();
    const std::string at = text(figure.at);
    const Unit unit = rowOf(figure.at.figure).unit;
    auto* entry = new QLineEdit;
    entry->setObjectName(QString::fromStdString("measured_" + at));
    if (const auto typed = entered.find(at); typed != entered.end()) entry->setText(typed->second);
    connect(entry, &QLineEdit::textChanged, this, [this] {
      const bool is_earlier = done_.tool.number != done_.found->last.number;
      if ((is_earlier || failed_) && this->entered().empty() && !working_.valid()) begin({});
    });
    const MeasuredFigure* measured = last.number == done_.tool.number ? last.find(figure.at) : nullptr;
    if (measured != nullptr) entry->setPlaceholderText(shown(measured->value, unit));
    const auto cell = [&](const std::string& name, double value) {
      auto* label = namedLabel(QString::fromStdString(name + "_" + at));
      if (known) label->setText(shown(value, unit) + " " + shopUnit(unit));
      if (known && !(std::abs(value - figure.asked) <= figure.tolerance)) {
        label->setStyleSheet(QString("color: %1;").arg(kWrong));
        label->setText(label->text() + ", out");
      }
      return label;
    };
    grid->addWidget(new QLabel(nameOf(figure.at)), row, kFigure);
    grid->addWidget(
        new QLabel(QString("%1 ± %2 %3").arg(shown(figure.asked, unit), shown(figure.tolerance, unit), shopUnit(unit))),
        row, kAsked);
    grid->addWidget(entry, row, kMeasured);
    grid->addWidget(cell("now", figure.now), row, kUnchanged);
    grid->addWidget(cell("after", figure.after), row, kCorrected);
    rows_.push_back({figure.at, entry});
  }
  qobject_cast<QVBoxLayout*>(layout())->insertWidget(1, table_);
}

void CorrectionDialog::keep() {
  std::vector<MeasuredFigure> figures;
  try {
    const GrindJob job = readJobFile(file_, operation_);
    for (auto [at, typed] : entered()) {
      // Point and comma are both the decimal sign, as in all boxes for numbers.
      figures.push_back(measuredFrom(at + "=" + typed.replace(',', '.').toStdString(), job));
    }
    if (figures.empty()) throw std::invalid_argument("nothing is entered");
  } catch (const std::exception& error) {
    return showText(error.what(), false);
  }
  begin(std::move(figures));
}

void CorrectionDialog::refresh(const std::optional<flute_grinder::WorkOffsets>& offsets, bool may) {
  offsets_ = offsets ? std::optional(fromMessage(*offsets)) : std::nullopt;
  // While the offsets could not be set, a tool may have been ground.
  if (may && !may_ && !working_.valid()) begin({});
  may_ = may;
  const bool ready = done_.found && !working_.valid();
  const std::string why_not = ready && offsets_ ? notCorrectable(done_.found->last, *offsets_, done_.basis) : "";
  const bool can_set = may && ready && offsets_ && why_not.empty();
  keep_->setEnabled(ready);
  apply_->setEnabled(can_set && done_.found->isKnown() && !done_.correction.in_dead_band && !isSet());
  back_->setEnabled(can_set && before_);
  apply_->setToolTip(why_not.empty() ? "Set the work offsets of Y and Z; nothing moves"
                                     : QString::fromStdString(why_not));
  if (!can_set) showQuestion(false);
}

/// Whether the present work offsets are the corrected ones.
bool CorrectionDialog::isSet() const {
  return (present() - done_.found->last.offset - done_.correction.turn).head<2>().cwiseAbs().maxCoeff() <= kSameOffset;
}

/// The present work offsets of Y and Z.
Turns CorrectionDialog::present() const {
  Turns offset = Turns::Zero();
  for (const CorrectedAxis& one : kCorrectedAxes) {
    offset[indexOf(one.turn)] = offsets_->axes[static_cast<std::size_t>(one.axis)].value;
  }
  return offset;
}

void CorrectionDialog::ask(const Turns& offset, const QString& text, const std::optional<Turns>& back_to) {
  Comparison figures{{"now", "then", "change"}, {}};
  for (const CorrectedAxis& one : kCorrectedAxes) {
    const double now = present()[indexOf(one.turn)], then = offset[indexOf(one.turn)];
    const auto cell = [](double value) { return shown(value, Unit::kMetre) + " mm"; };
    figures.rows.push_back({QString(axisLetter(one.axis)), cell(now), cell(then), cell(then - now)});
  }
  // The figures are shown here: the answer to a large change is given with them.
  const auto request = offsetsRequest(offsetsOf(offset), done_.basis, {toString(NeedAnswer::kSetOffset)});
  const std::string by_hand = back_to ? byHandText(done_.correction) : "";
  const QString also = by_hand.empty() ? "" : QString::fromStdString(" Then " + by_hand + ".");
  question_->ask(
      text + also, figures,
      {{"confirm_correction", "Set them", "What is shown then counts; nothing moves", false, [this, request, back_to] {
          back_to_ = back_to;
          Q_EMIT wanted(request);
        }}});
  showQuestion(true);
}

void CorrectionDialog::showAnswer(const std::string& refusal) {
  if (!refusal.empty()) return showText(QString::fromStdString(refusal), false);
  const std::string by_hand = back_to_ ? byHandText(done_.correction) : "";
  before_ = back_to_;
  showText(
      "The work offsets of Y and Z are set. " +
          (by_hand.empty() ? "Grind the next tool." : QString::fromStdString("Before the next tool, " + by_hand + ".")),
      true);
}

void CorrectionDialog::showText(const QString& text, bool good) {
  says_->setText(text);
  says_->setStyleSheet(good ? "" : QString("color: %1;").arg(kWrong));
}

void CorrectionDialog::showQuestion(bool asks) {
  buttons_->setVisible(!asks);
  question_->setVisible(asks);
}

}  // namespace grinder
