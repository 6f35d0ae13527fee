#include "panel/offset_question.h"

#include "flute_grinder/messages/offset_basis.h"
#include "panel/text_view.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace flute_grinder {

namespace {

constexpr int kQuestionLines = 3;  ///< of the question that have room; the others are scrolled to

}  // namespace

OffsetQuestion::OffsetQuestion(QWidget* parent)
    : QWidget(parent), text_(textView("offsets_to_set", kQuestionLines)), fit_(new QPushButton) {
  setObjectName("offset_question");
  fit_->setObjectName("fit_offsets");
  fit_->setToolTip("Computed from what they were set for: the wheel and the swivel are the same. Plans the job again");
  auto* right = new QPushButton("They are right");
  right->setObjectName("offsets_are_right");
  right->setToolTip("Start the job with the work offsets as they are");
  auto* decline = new QPushButton("Not yet");
  decline->setObjectName("decline_offsets");
  decline->setToolTip("Start nothing");
  auto* buttons = new QHBoxLayout;
  for (QPushButton* button : {fit_, right, decline}) buttons->addWidget(button, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(text_, 1);
  layout->addLayout(buttons);
  connect(fit_, &QPushButton::clicked, this, &OffsetQuestion::fitted);
  connect(right, &QPushButton::clicked, this, &OffsetQuestion::foundRight);
  connect(decline, &QPushButton::clicked, this, &OffsetQuestion::declined);
}

void OffsetQuestion::ask(const std::vector<core::OffsetMisfit>& misfits) {
  QString text;
  for (const core::OffsetMisfit& misfit : misfits) {
    text += (text.isEmpty() ? "" : "\n") + QString::fromStdString(misfit.reason) + ".";
  }
  showText(*text_, text, true);
  const QString axes = QString::fromStdString(computable(misfits));
  fit_->setText("Fit " + axes);
  fit_->setVisible(!axes.isEmpty());
}

}  // namespace flute_grinder
