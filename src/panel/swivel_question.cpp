#include "panel/swivel_question.h"

#include "flute_grinder/job/quantity.h"

#include <QHBoxLayout>
#include <QPushButton>
#include <QVBoxLayout>

namespace flute_grinder {

namespace {

constexpr int kDigits = 10;  ///< so that the angle appears as in the job file

}  // namespace

bool needsConfirmation(const GrindGoal& goal, const Swivel& swivel) {
  return !swivel.measured && !swivel.isAt(goal.process.setup_swivel);
}

SwivelQuestion::SwivelQuestion(QWidget* parent) : QWidget(parent), text_(new QLabel) {
  setObjectName("swivel_question");
  text_->setObjectName("swivel_to_set");
  text_->setWordWrap(true);
  text_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  auto* confirm = new QPushButton("Confirm");
  confirm->setObjectName("confirm_swivel");
  confirm->setToolTip("The swivel is set and clamped: start the job");
  auto* decline = new QPushButton("Not yet");
  decline->setObjectName("decline_swivel");
  decline->setToolTip("Start nothing");
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(confirm, 1);
  buttons->addWidget(decline, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(text_, 1);
  layout->addLayout(buttons);
  connect(confirm, &QPushButton::clicked, this, [this] { Q_EMIT confirmed(angle_); });
  connect(decline, &QPushButton::clicked, this, &SwivelQuestion::declined);
}

void SwivelQuestion::ask(double angle) {
  angle_ = angle;
  text_->setText(QString::fromStdString("Set the swivel to " +
                                        text(Quantity{angle, Unit::kRadian}, UnitSystem::kShop, kDigits) +
                                        ". Is it set and clamped?"));
}

}  // namespace flute_grinder
