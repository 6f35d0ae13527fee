#include "panel/question.h"

#include "panel/panel_button.h"
#include "panel/text_view.h"

#include <QGridLayout>

namespace grinder {

namespace {

constexpr int kAppearing = 1000;  ///< [ms]

}  // namespace

Question::Question(const QString& name, int lines)
    : text_(textView((name + "_question").toLatin1(), lines)), layout_(new QGridLayout(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  layout_->setVerticalSpacing(2);
  layout_->addWidget(text_, 0, 0, 1, 2);
  layout_->setRowStretch(0, 1);
  for (const int column : {0, 1}) layout_->setColumnStretch(column, 1);
  addAnswer(("decline_" + name).toLatin1(), "Not yet", "Do nothing", 1, 1, [] {});
  appearing_.setSingleShot(true);
  appearing_.setInterval(kAppearing);
  connect(&appearing_, &QTimer::timeout, this, [this] { enableAnswers(true); });
}

QPushButton* Question::addAnswer(const char* name, const QString& text, const QString& hint, int row, int column,
                                 const std::function<void()>& act) {
  auto* button = new PanelButton(name, text, hint);
  button->setEnabled(false);
  // One that is not offered must not move the others.
  QSizePolicy policy = button->sizePolicy();
  policy.setRetainSizeWhenHidden(true);
  button->setSizePolicy(policy);
  layout_->addWidget(button, 1 + row, column);
  connect(button, &QPushButton::clicked, this, [this, act] {
    Q_EMIT answered();
    act();
  });
  return button;
}

QPushButton* Question::addDanger(const char* name, const QString& text, const QString& hint,
                                 const std::function<void()>& act) {
  auto* button = addAnswer(name, text, hint, 0, 0, act);
  QFont small = button->font();
  small.setPointSize(small.pointSize() - 2);
  button->setFont(small);
  layout_->setAlignment(button, Qt::AlignLeft);
  return button;
}

void Question::ask(const QString& text) {
  showText(*text_, text, true);
  enableAnswers(false);
  appearing_.start();
}

void Question::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  enableAnswers(false);
  appearing_.start();
}

void Question::enableAnswers(bool enabled) {
  for (auto* answer : findChildren<QPushButton*>()) answer->setEnabled(enabled);
}

}  // namespace grinder
