#include "panel/question.h"

#include "panel/panel_button.h"

#include <QGridLayout>
#include <QLabel>
#include <QScrollBar>

namespace grinder {

namespace {

constexpr int kAppearing = 1000;  ///< time without answers after it appears [ms]
constexpr int kSmaller = 2;       ///< reduction of the text of a dangerous answer [pt]

}  // namespace

Question::Question(const QString& name, int lines)
    : text_(new QTextEdit), more_(new QLabel("Scroll down to answer")), layout_(new QGridLayout(this)) {
  text_->setObjectName(name + "_question");
  text_->setReadOnly(true);
  text_->setTabChangesFocus(true);
  text_->setWordWrapMode(QTextOption::WrapAtWordBoundaryOrAnywhere);
  text_->setMinimumHeight(lines * text_->fontMetrics().lineSpacing() + 12);
  // The borders of a table exceed its width.
  text_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  more_->setObjectName(name + "_more");
  more_->setAutoFillBackground(true);
  more_->setBackgroundRole(QPalette::ToolTipBase);
  more_->setForegroundRole(QPalette::ToolTipText);
  more_->setAlignment(Qt::AlignCenter);
  auto* over = new QVBoxLayout(text_->viewport());
  over->setContentsMargins(0, 0, 0, 0);
  over->addWidget(more_, 1, Qt::AlignBottom);
  layout_->setContentsMargins(0, 0, 0, 0);
  layout_->setVerticalSpacing(2);
  layout_->addWidget(text_, 0, 0, 1, 2);
  layout_->setRowStretch(0, 1);
  for (const int column : {0, 1}) layout_->setColumnStretch(column, 1);
  decline_ = addAnswer(("decline_" + name).toLatin1(), "Not yet", "Do nothing", 1, 1, [] {});
  appearing_.setSingleShot(true);
  appearing_.setInterval(kAppearing);
  connect(&appearing_, &QTimer::timeout, this, &Question::enableAnswers);
  connect(text_->verticalScrollBar(), &QScrollBar::valueChanged, this, &Question::enableAnswers);
  connect(text_->verticalScrollBar(), &QScrollBar::rangeChanged, this, &Question::enableAnswers);
}

QPushButton* Question::addAnswer(const char* name, const QString& text, const QString& hint, int row, int column,
                                 const std::function<void()>& act) {
  auto* button = new PanelButton(name, text, hint);
  button->setEnabled(false);
  // An answer that is not offered must not move the others.
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

QPushButton* Question::addDanger(const char* name, const QString& text, const QString& hint, int row, int column,
                                 const std::function<void()>& act) {
  QPushButton* button = addAnswer(name, text, hint, row, column, act);
  QFont font = button->font();
  font.setPointSize(font.pointSize() - kSmaller);
  button->setFont(font);
  layout_->setAlignment(button, Qt::AlignLeft);
  return button;
}

void Question::ask(const QString& text, const Comparison& figures) {
  const QString paragraphs = text.toHtmlEscaped().replace("\n", "<br/>");
  text_->setHtml("<p>" + paragraphs + "</p>" + figures.html());
  appear();
}

void Question::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  appear();
}

void Question::appear() {
  seen_ = false;
  appearing_.start();
  enableAnswers();
}

void Question::enableAnswers() {
  const QScrollBar& bar = *text_->verticalScrollBar();
  const bool appeared = !appearing_.isActive();
  // Only once the text has its size.
  if (appeared && bar.value() == bar.maximum()) seen_ = true;
  more_->setVisible(bar.value() < bar.maximum());
  for (auto* answer : findChildren<QPushButton*>()) answer->setEnabled(appeared && (seen_ || answer == decline_));
}

}  // namespace grinder
