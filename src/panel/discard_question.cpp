#include "panel/discard_question.h"

#include "flute_grinder/messages/conversions.h"
#include "panel/plain_words.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace flute_grinder {

bool discardsUnfinished(const GrindGoal& goal, const JobProgress& progress) {
  if (progress.job_digest.empty() || progress.finished) return false;
  const bool goes_on = goal.first_tooth == progress.tooth && goal.first_pass == progress.pass;
  return !(goes_on && progress.job_digest == jobDigest(jobFromGoal(goal)));
}

DiscardQuestion::DiscardQuestion(QWidget* parent) : QWidget(parent), text_(new QLabel), keep_(new QPushButton) {
  setObjectName("discard_question");
  text_->setObjectName("unfinished_job");
  text_->setWordWrap(true);
  text_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  auto* discard = new QPushButton("Discard it");
  discard->setObjectName("discard");
  discard->setToolTip("Start the planned job; the other cannot be continued any more");
  keep_->setObjectName("keep");
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(discard, 1);
  buttons->addWidget(keep_, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(text_, 1);
  layout->addLayout(buttons);
  connect(discard, &QPushButton::clicked, this, &DiscardQuestion::discarded);
  connect(keep_, &QPushButton::clicked, this, &DiscardQuestion::kept);
}

void DiscardQuestion::ask(const JobProgress& progress, bool continuable) {
  text_->setText("Not finished: " + QString::fromStdString(describe(progress)) +
                 ". Once this job starts it cannot be continued.");
  keep_->setText(continuable ? "Continue it" : "Keep it");
  keep_->setToolTip(continuable ? "Plan the job from where it was left" : "Start nothing");
}

}  // namespace flute_grinder
