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
  decline_ = addButton({"decline_" + name, "Not yet", "Do nothing", false, [] {}}, 1, 1);
  layout_->setRowMinimumHeight(1, decline_->sizeHint().height());  // where the first answers come
  appearing_.setSingleShot(true);
  appearing_.setInterval(kAppearing);
  connect(&appearing_, &QTimer::timeout, this, &Question::enableAnswers);
  connect(text_->verticalScrollBar(), &QScrollBar::valueChanged, this, &Question::enableAnswers);
  connect(text_->verticalScrollBar(), &QScrollBar::rangeChanged, this, &Question::enableAnswers);
}

QPushButton* Question::addButton(const Answer& answer, int row, int column) {
  auto* button = new PanelButton(answer.name, answer.text, answer.hint);
  button->setEnabled(false);
  layout_->addWidget(button, 1 + row, column);
  connect(button, &QPushButton::clicked, this, [this, act = answer.act] {
    Q_EMIT answered();
    act();
  });
  if (!answer.danger) return button;
  QFont font = button->font();
  font.setPointSize(font.pointSize() - kSmaller);
  button->setFont(font);
  layout_->setAlignment(button, Qt::AlignLeft);
  return button;
}

void Question::ask(const QString& text, const Comparison& figures, const std::vector<Answer>& answers) {
  const QString paragraphs = text.toHtmlEscaped().replace("\n", "<br/>");
  text_->setHtml("<p>" + paragraphs + "</p>" + figures.html());
  // An answer asks the next question: its button is still at work.
  for (QPushButton* button : answers_) {
    button->setParent(nullptr);
    button->deleteLater();
  }
  answers_.clear();
  danger_row_ = 1 - danger_row_;
  int row = 0, danger_row = danger_row_;
  for (const Answer& answer : answers) {
    answers_.push_back(addButton(answer, answer.danger ? danger_row : row, answer.danger ? 0 : 1));
    (answer.danger ? danger_row : row) += 2;
  }
  appear();
}

void Question::ask(const flute_grinder::Need& need, const QString& about,
                   const std::function<void(const flute_grinder::NeedAnswer& answer)>& act) {
  Comparison figures{{"asked", "set", "off by"}, {}};
  for (const flute_grinder::NeedFigure& figure : need.figures) {
    QStringList row;
    for (const std::string* cell : {&figure.what, &figure.asked, &figure.set, &figure.difference}) {
      row << QString::fromStdString(*cell);
    }
    figures.rows.push_back(row);
  }
  std::vector<Answer> answers;
  for (const flute_grinder::NeedAnswer& answer : need.answers) {
    answers.push_back({QString::fromStdString(answer.id).section('#', 0, 0), QString::fromStdString(answer.text),
                       QString::fromStdString(answer.help), answer.danger != 0, [act, answer] { act(answer); }});
  }
  QStringList text;
  for (const QString& part :
       {about, QString::fromStdString(need.figures.empty() ? need.text : ""), QString::fromStdString(need.question)}) {
    if (!part.isEmpty()) text << part;
  }
  ask(text.join("\n"), figures, answers);
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
  decline_->setEnabled(appeared);
  for (QPushButton* answer : answers_) answer->setEnabled(appeared && seen_);
}

}  // namespace grinder
