#include "panel/readout.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "panel/plain_words.h"
#include "panel/text_view.h"

#include <QFontDatabase>
#include <QGridLayout>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grinder {

namespace {

using namespace units;

constexpr const char* kGrey = "#5f6368";
constexpr const char* kBlue = "#1a5fb4";

/// The colour of a state. Green: a job may begin. Blue: the axes move. Amber: they rest during a job, or are about to.
const char* colourOf(const flute_grinder::GrinderState& grinder) {
  if (grinder.power_stays_on) return kWrong;
  switch (rowOf(static_cast<MachineState>(grinder.state)).group) {
    case StateGroup::kReady: return grinder.wheel_in_work || grinder.spindle_commanded ? kAmber : kGreen;
    case StateGroup::kActive: return kBlue;
    case StateGroup::kPausing: return kAmber;
    case StateGroup::kFault: return kWrong;
    case StateGroup::kOff: break;
  }
  return kGrey;
}

constexpr const char* kStrokeDone = "Stroke %p %";
constexpr const char* kJobDone = "Job %p %";
constexpr int kBarHeight = 8;  ///< height of a bar [px]
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Decimals of positions [mm, deg]: micrometres, and no finer than encoders read.
constexpr int kFewestDecimals = 3, kMaxDecimals = 4;

/// A distance to go in mm or deg, short enough for four in a line. @param to_go [m], A [rad].
QString toGoText(int axis, double to_go) {
  const double shown = to_go / shopScale(unitOf(axis, 0));
  const int decimals = std::abs(shown) < 99.9995 ? kFewestDecimals : 1;
  return QString("%1 %2").arg(axisLetter(axis)).arg(QString::fromStdString(fixed(shown, decimals)));
}

/// A feed in mm/min with three digits, so that the feed of a small tool shows too. @param feed [m/s].
QString feedText(double feed) {
  const double shown = feed / kMillimetrePerMinute;
  const int decimals = shown == 0 || shown >= 99.95 ? 0 : shown >= 9.995 ? 1 : 2;
  return QString("%1 mm/min").arg(shown, 0, 'f', decimals);
}

}  // namespace

StateBox::StateBox(QWidget* parent)
    : QWidget(parent),
      node_(namedLabel("grinder")),
      swivel_(namedLabel("swivel")),
      name_(namedLabel("state")),
      meaning_(namedLabel("meaning")) {
  node_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  name_->setAlignment(Qt::AlignCenter);
  QFont font = name_->font();
  font.setPointSize(font.pointSize() * 3 / 2);
  font.setBold(true);
  name_->setFont(font);
  meaning_->setWordWrap(true);
  meaning_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  // Reserve room for the usual texts, so that the buttons below do not move.
  meaning_->setMinimumHeight(3 * meaning_->fontMetrics().lineSpacing() + 4);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  auto* head = new QHBoxLayout;
  head->addWidget(node_, 1);
  head->addWidget(swivel_);
  layout->addLayout(head);
  layout->addWidget(name_);
  layout->addWidget(meaning_);
}

void StateBox::setNode(const QString& node) {
  showName(*node_, node);
  node_->setToolTip(node);
}

void StateBox::setName(const QString& name, const QString& colour) {
  const QString style = QString("background: %1; color: white; padding: 4px; border-radius: 4px;").arg(colour);
  name_->setText(name);
  if (style != name_->styleSheet()) name_->setStyleSheet(style);  // setStyleSheet() is slow
}

void StateBox::show(const GrinderView& view, const QString& node, Master master) {
  setNode(node);
  swivel_->setText(view.state ? QString::fromStdString(swivelText(*view.state)) : "");
  if (!view.state) {
    setName("No answer", kGrey);
    meaning_->setText(master == Master::kMissing
                          ? "No ROS master answers, and nothing comes from the grinder " + node + "."
                          : "No grinder answers as " + node + ". Does its node run?");
    return;
  }
  QString name = QString::fromStdString(view.state->state_name);
  if (!name.isEmpty()) name[0] = name[0].toUpper();
  name.replace('_', ' ');
  setName(name, colourOf(*view.state));
  const QString alone = "No ROS master answers; Hold, Cancel and Disable work without. ";
  meaning_->setText((master == Master::kMissing ? alone : "") + QString::fromStdString(describe(*view.state)));
}

ProgressBox::ProgressBox(QWidget* parent)
    : QWidget(parent),
      place_(namedLabel("place")),
      feed_(namedLabel("feed")),
      stroke_(makeBar("stroke", "stroke_text")),
      job_(makeBar("job", "job_text")) {
  place_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  feed_->setAlignment(Qt::AlignRight);
  feed_->setMinimumWidth(feed_->fontMetrics().horizontalAdvance("10000 mm/min"));
  // Changing texts must not make the panel grow.
  stroke_.text->setMinimumWidth(stroke_.text->fontMetrics().horizontalAdvance("Stroke 100 %") + 4);
  job_.text->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  auto* place = new QHBoxLayout;
  place->addWidget(place_, 1);
  place->addWidget(feed_);
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setVerticalSpacing(3);
  layout->setColumnStretch(1, 1);
  layout->addLayout(place, 0, 0, 1, 2);
  layout->addWidget(stroke_.text, 1, 0);
  layout->addWidget(job_.text, 1, 1);
  layout->addWidget(stroke_.bar, 2, 0);
  layout->addWidget(job_.bar, 2, 1);
}

ProgressBox::Bar ProgressBox::makeBar(const char* name, const char* text_name) {
  const Bar made{new QProgressBar, namedLabel(text_name)};
  made.bar->setObjectName(name);
  made.bar->setRange(0, 1000);
  made.bar->setTextVisible(false);
  made.bar->setFixedHeight(kBarHeight);
  return made;
}

void ProgressBox::set(const Bar& bar, const QString& format, double fraction, bool enabled) {
  bar.bar->setFormat(format);
  bar.bar->setValue(static_cast<int>(std::clamp(fraction, 0.0, 1.0) * bar.bar->maximum()));
  bar.text->setText(bar.bar->text());
  bar.bar->setEnabled(enabled);
  bar.text->setEnabled(enabled);
}

void ProgressBox::show(const GrinderView& view, bool job_runs) {
  if (view.planned) return showPlanning(*view.planned);
  const flute_grinder::GrindFeedback f = view.feedback ? view.feedback->feedback : flute_grinder::GrindFeedback();
  set(stroke_, kStrokeDone, f.stroke_fraction, job_runs);
  if (!view.feedback || !job_runs) {
    place_->setText(view.state ? "No job runs" : "");
    feed_->clear();
    return set(job_, kJobDone, f.job_fraction, job_runs);
  }
  showPlace(view, f);
  feed_->setText(feedText(f.feed));
  // The grinder's estimate assumes the job's own feed.
  const bool at_feed = !view.state || view.state->override == 1;
  const QString left = QString::fromStdString(duration(f.remaining_time)) + (at_feed ? " left" : " left at 100 %");
  set(job_, QString(kJobDone) + ", " + left, f.job_fraction, true);
}

void ProgressBox::showPlace(const GrinderView& view, const flute_grinder::GrindFeedback& feedback) {
  const QString name = view.job ? QString::fromStdString(view.job->goal.job_name) : "";
  const auto operation = view.job ? operationOf(view.job->goal) : std::nullopt;
  QString rest = QString("tooth %1, pass %2").arg(feedback.tooth + 1).arg(feedback.pass + 1);
  QString hint = name;
  if (operation) {
    rest = toString(*operation) + (", " + rest);
    hint += ", " + QString::fromStdString(operationEntry(view.job->goal.operation, *operation));
  }
  if (name.isEmpty()) rest[0] = rest[0].toUpper();
  showName(*place_, name, name.isEmpty() ? rest : ", " + rest);
  place_->setToolTip(hint);
}

void ProgressBox::showPlanning(double planned) {
  place_->setText("A job is planned");
  feed_->clear();
  set(stroke_, kStrokeDone, 0, false);
  set(job_, "Planning %p %", planned, true);
}

PositionBox::PositionBox(QWidget* parent)
    : QWidget(parent), to_go_title_(namedLabel("to_go")), decimals_(kFewestDecimals) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setVerticalSpacing(1);
  QFont font = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  font.setPointSize(font.pointSize() + 2);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    QLabel* value = namedLabel(QString("position_%1").arg(QChar(axisLetter(axis)).toLower()));
    value->setFont(font);
    value->setMinimumWidth(value->fontMetrics().horizontalAdvance("A -0000.0000 deg"));
    layout->addWidget(value, axis / 2, axis % 2);
    values_[static_cast<std::size_t>(axis)] = value;
  }
  auto* to_go = new QHBoxLayout;
  to_go->setSpacing(4);
  QFont small = this->font();
  small.setPointSize(small.pointSize() - 1);
  to_go_title_->setFont(small);
  to_go->addWidget(to_go_title_);
  for (int axis = 0; axis < kAxisCount; ++axis) {
    QLabel* label = namedLabel(QString("to_go_%1").arg(QChar(axisLetter(axis)).toLower()));
    label->setFont(small);
    label->setToolTip(QString("Distance to go to the end of the running move in %1").arg(shopUnit(unitOf(axis, 0))));
    // A long text must not make the panel grow.
    label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    to_go->addWidget(label, 1);
    to_go_[static_cast<std::size_t>(axis)] = label;
  }
  layout->addLayout(to_go, 2, 0, 1, 2);
}

void PositionBox::setTolerance(std::optional<double> tolerance) {
  const double decimals = std::ceil(-std::log10(tolerance.value_or(kMicrometre) / kMillimetre) - 1e-9);
  // The tolerance of a malformed legend may be 0 or NaN, without a usable logarithm.
  decimals_ = !(decimals <= kMaxDecimals)      ? kMaxDecimals
              : !(decimals >= kFewestDecimals) ? kFewestDecimals
                                               : static_cast<int>(decimals);
}

void PositionBox::show(const GrinderView& view) {
  // At rest the distance to go is 0 in every axis; during a move it is not.
  const bool moves = view.state && !(Axes(view.state->distance_to_go.data()) == 0).all();
  to_go_title_->setText(moves ? "To go" : " ");
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const Unit unit = unitOf(axis, 0);
    const auto shown = [&](double si) {
      return std::isfinite(si) ? QString::fromStdString(fixed(si / shopScale(unit), decimals_)) : QString("-");
    };
    QLabel& label = *values_[static_cast<std::size_t>(axis)];
    const double work = view.work_position ? (*view.work_position)[axis] : kUnknown;
    const double machine = view.position ? (*view.position)[axis] : kUnknown;
    label.setText(QString("%1 %2 %3").arg(axisLetter(axis)).arg(shown(work), decimals_ + 6).arg(shopUnit(unit)));
    const double to_go = view.state ? view.state->distance_to_go[static_cast<std::size_t>(axis)] : 0;
    to_go_[static_cast<std::size_t>(axis)]->setText(moves ? toGoText(axis, to_go) : "");
    label.setToolTip(QString("Position in work coordinates.\nMachine: %1 %3\nWork offset: %2 %3")
                         .arg(shown(machine), shown(machine - work), shopUnit(unit)));
  }
}

}  // namespace grinder
