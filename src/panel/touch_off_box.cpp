#include "panel/touch_off_box.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/machine/offset_fit.h"
#include "flute_grinder/messages/offset_basis.h"
#include "panel/panel_button.h"
#include "panel/text_view.h"

#include <QDateTime>
#include <QGridLayout>
#include <QVBoxLayout>

#include <cmath>

namespace grinder {

namespace {

constexpr double kMoved = 10e-6;  ///< change of position that counts as a motion [m], A [rad]
constexpr int kDecimals = 4;      ///< decimals of positions and offsets
constexpr int kLinesOfChange = 4;
constexpr int kLinesOfOffset = 3;
constexpr double kFarthest = 9999;  ///< largest entry [mm or deg]

double scaleOf(int axis) { return shopScale(unitOf(axis, 0)); }
const char* unitName(int axis) { return shopUnit(unitOf(axis, 0)); }

}  // namespace

TouchOffBox::TouchOffBox(QWidget* parent)
    : QWidget(parent),
      axis_(new QComboBox),
      at_(new NumberBox("touch_at", kDecimals)),
      touch_(
          new PanelButton("touch_off", "Touch off", "Set the axis' work offset from where it is now; nothing moves")),
      back_(new PanelButton("touch_back", "Back", "Set the offset that was touched off last to what it was before")),
      reclamped_(new PanelButton("reclamped", "New clamping", "Say that a tool was clamped: another one, or anew")),
      measured_(new PanelButton("measured", "Measured...",
                                "Enter what was measured of the job's last tool, and correct the zero points by it")),
      offset_(namedLabel("work_offset")),
      tool_(namedLabel("tool")),
      question_(new Question("touch", kLinesOfChange)),
      pages_(new QStackedLayout) {
  axis_->setObjectName("touch_axis");
  for (const char name : {'X', 'Y', 'Z', 'A'}) axis_->addItem(QString(name));
  offset_->setWordWrap(true);
  offset_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  // A long text must not make the panel grow.
  offset_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Ignored);
  offset_->setMinimumHeight(kLinesOfOffset * offset_->fontMetrics().lineSpacing() + 4);
  tool_->setWordWrap(true);
  tool_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  auto* form = new QWidget;
  auto* layout = new QGridLayout(form);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(axis_, 0, 0);
  layout->addWidget(at_, 0, 1);
  layout->addWidget(touch_, 0, 2);
  layout->addWidget(offset_, 1, 0, 1, 2);
  layout->addWidget(back_, 1, 2, Qt::AlignTop);
  layout->addWidget(tool_, 2, 0, 1, 2);
  layout->addWidget(reclamped_, 2, 2, Qt::AlignTop);
  layout->addWidget(measured_, 3, 2, Qt::AlignTop);
  layout->setColumnStretch(1, 1);
  layout->setRowStretch(4, 1);
  connect(axis_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &TouchOffBox::chooseAxis);
  connect(touch_, &QPushButton::clicked, this, [this] {
    if (at_->isGood()) Q_EMIT wanted(axis(), at_->value() * scaleOf(axis()));
  });
  connect(back_, &QPushButton::clicked, this, &TouchOffBox::backWanted);
  connect(reclamped_, &QPushButton::clicked, this, &TouchOffBox::reclampedWanted);
  connect(measured_, &QPushButton::clicked, this, &TouchOffBox::measuredWanted);
  connect(question_, &Question::answered, this, [this] { pages_->setCurrentIndex(0); });
  auto* around = new QVBoxLayout(this);
  around->setContentsMargins(6, 6, 6, 6);
  around->addLayout(pages_);
  pages_->addWidget(form);
  pages_->addWidget(question_);
  chooseAxis();
}

void TouchOffBox::ask(const QString& text, const Comparison& figures, const std::function<void()>& done) {
  question_->ask(text, figures,
                 {{"confirm_touch", "It is so", "What is shown then counts; nothing moves", false, done}});
  showQuestion();
}

void TouchOffBox::ask(const flute_grinder::Need& need, const std::function<void(const std::string& id)>& answered) {
  question_->ask(need, "", [answered](const flute_grinder::NeedAnswer& answer) { answered(answer.id); });
  showQuestion();
}

void TouchOffBox::showQuestion() {
  asked_at_ = position_;
  pages_->setCurrentWidget(question_);
}

void TouchOffBox::offerBack(int axis) {
  back_axis_ = axis;
  back_->setText(axis < kAxisCount ? QString("Back, %1").arg(axisLetter(axis)) : "Back");
}

void TouchOffBox::chooseAxis() {
  const bool diameter = axis() == kY;
  at_->setRange(diameter ? 0 : -kFarthest, kFarthest);
  at_->setValue(0);
  at_->setPrefix(diameter ? "D " : "at ");
  at_->setSuffix(QString(" ") + unitName(axis()));
  at_->setToolTip(diameter ? "Diameter of the blank that the wheel touches; the job file has the rest"
                           : "Where the axis is, in work coordinates");
}

bool TouchOffBox::maySet(const GrinderView& view) {
  using State = flute_grinder::GrinderState;
  return view.state && (view.state->state == State::READY || view.state->state == State::DISABLED) &&
         view.state->homed != 0;
}

void TouchOffBox::refresh(const GrinderView& view, bool has_services, bool has_job) {
  if (view.state) position_ = view.state->position[static_cast<std::size_t>(axis())];
  if (!view.state || !(std::abs(position_ - asked_at_) <= kMoved)) pages_->setCurrentIndex(0);
  const bool given = at_->isGood() && (axis() != kY || at_->value() > 0);
  const bool may = has_services && maySet(view);
  touch_->setEnabled(may && given);
  back_->setEnabled(may && back_axis_ < kAxisCount && view.offsets);
  reclamped_->setEnabled(has_services && view.state && !isInJob(static_cast<MachineState>(view.state->state)));
  measured_->setEnabled(has_job);
  const QString tool = view.offsets ? QString::fromStdString(toolText(fromMessage(*view.offsets).tool)) : "";
  tool_->setToolTip(tool);
  tool_->setText("Tool: " + tool);
  const QString text = offsetText(view);
  if (text == offset_->text()) return;
  offset_->setText(text);
  offset_->setToolTip(text);
}

QString TouchOffBox::offsetText(const GrinderView& view) const {
  if (!view.offsets) return "";
  const auto i = static_cast<std::size_t>(axis());
  const double value = view.offsets->values[i];
  const QString error = QString::fromStdString(view.offsets->error);
  if (!std::isfinite(value)) return QString("Work offset of %1 is unknown: %2").arg(axis_->currentText(), error);
  QString text = QString("Work offset of %1: %2 %3, ")
                     .arg(axis_->currentText())
                     .arg(QString::fromStdString(fixed(value / scaleOf(axis()), kDecimals)))
                     .arg(unitName(axis()));
  const ros::Time& at = view.offsets->set_at[i];
  if (at.isZero()) return text + "never set";
  const QString time = QDateTime::fromSecsSinceEpoch(at.sec).toString("yyyy-MM-dd HH:mm:ss");
  text += QString("set by %1, %2; ").arg(QString::fromStdString(view.offsets->set_by[i]), time);
  return text + QString::fromStdString(basisText(axis(), fromMessage(*view.offsets).axes[i]));
}

}  // namespace grinder
