#include "panel/override_box.h"

#include "flute_grinder/motion/feed_schedule.h"
#include "panel/text_view.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSignalBlocker>

#include <cmath>

namespace grinder {

namespace {

constexpr int kRest = 300;    ///< time after which a slider moved by the mouse wheel counts as at rest [ms]
constexpr int kSettle = 200;  ///< time within which several state messages arrive [ms]
const int kMaxPercent = static_cast<int>(std::lround(kMaxFeedOverride * 100));

/// A slider that no key moves: a key pressed by accident could start the axes from an override of 0.
class MouseSlider : public QSlider {
 public:
  using QSlider::QSlider;

 protected:
  void keyPressEvent(QKeyEvent* event) override { event->ignore(); }
};

}  // namespace

OverrideBox::OverrideBox(QWidget* parent)
    : QWidget(parent), slider_(new MouseSlider(Qt::Horizontal)), value_(namedLabel("override_value")) {
  slider_->setObjectName("override");
  slider_->setRange(0, kMaxPercent);
  slider_->setPageStep(10);
  slider_->setTickInterval(20);
  slider_->setTickPosition(QSlider::TicksBelow);
  slider_->setToolTip("Part of the job's feed; rapids keep their speed");
  value_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  value_->setMinimumWidth(value_->fontMetrics().horizontalAdvance(QString("%1 %").arg(kMaxPercent)) + 4);
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(new QLabel("Feed override"));
  layout->addWidget(slider_, 1);
  layout->addWidget(value_);

  rest_.setSingleShot(true);
  rest_.setInterval(kRest);
  settle_.setSingleShot(true);
  settle_.setInterval(kSettle);
  connect(&rest_, &QTimer::timeout, this, &OverrideBox::emitWanted);
  connect(slider_, &QSlider::sliderReleased, this, &OverrideBox::emitWanted);
  connect(slider_, &QSlider::valueChanged, this, [this](int percent) {
    value_->setText(QString("%1 %").arg(percent));
    rest_.start();
  });
}

void OverrideBox::emitWanted() {
  rest_.stop();
  // Nothing is requested while the mouse holds the slider. Qt releases a slider that is disabled meanwhile.
  if (slider_->isSliderDown() || !slider_->isEnabled()) return;
  ++unanswered_;
  Q_EMIT wanted(slider_->value() / 100.0);
}

void OverrideBox::answered() {
  --unanswered_;
  settle_.start();
}

void OverrideBox::reset() { unanswered_ = 0; }

void OverrideBox::refresh(const std::optional<flute_grinder::GrinderState>& state) {
  slider_->setEnabled(state.has_value());
  const bool asking = slider_->isSliderDown() || rest_.isActive() || unanswered_ > 0 || settle_.isActive();
  if (!state) value_->clear();
  if (!state || asking) return;
  const int percent = static_cast<int>(std::lround(state->override * 100));
  const QSignalBlocker programmatic(slider_);
  slider_->setValue(percent);
  value_->setText(QString("%1 %").arg(percent));
}

}  // namespace grinder
