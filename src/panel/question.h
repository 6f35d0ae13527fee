#pragma once

#include "flute_grinder/Need.h"
#include "panel/comparison.h"

#include <QPushButton>
#include <QTextEdit>
#include <QTimer>
#include <QWidget>

#include <functional>
#include <vector>

class QGridLayout;
class QLabel;

namespace grinder {

/// A question before an action that the operator may not want: a text, and the answers below it in two columns, with
/// *Not yet*, which does nothing, always in the same place. For a second after it appears it takes no answer, because
/// the click may be meant for what was there before; for the same reason an answer that costs a wheel or a tool is in
/// another place than the one of the question before. Until its end has been in sight it takes only *Not yet*, because
/// the deciding figures may be in the last line. No key gives an answer.
class Question : public QWidget {
  Q_OBJECT

 public:
  struct Answer {
    QString name;  ///< of the button
    QString text, hint;
    bool danger = false;        ///< given by mistake, it costs a wheel or a tool: a smaller button on the left
    std::function<void()> act;  ///< called after answered()
  };

  /// @param name names the text NAME_question and *Not yet* decline_NAME. @param lines lines of text that have room.
  Question(const QString& name, int lines);

  /// @param figures figures below the text, on which the answer depends.
  void ask(const QString& text, const Comparison& figures, const std::vector<Answer>& answers);

  /// Asks what the grinder needs to be told. @param about what it is about, ahead of the question.
  /// @param act gets the answer.
  void ask(const flute_grinder::Need& need, const QString& about,
           const std::function<void(const flute_grinder::NeedAnswer& answer)>& act);

 Q_SIGNALS:
  /// An answer was given, perhaps *Not yet*: the question is to be hidden.
  void answered();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  QPushButton* addButton(const Answer& answer, int row, int column);
  void appear();
  void enableAnswers();

  QTextEdit* text_;
  QPushButton* decline_;
  QLabel* more_;
  std::vector<QPushButton*> answers_;  ///< all but *Not yet*
  int danger_row_ = 0;                 ///< of the first dangerous answer; the other one in the next question
  bool seen_ = false;                  ///< its end has been in sight since it appeared
  QGridLayout* layout_;
  QTimer appearing_;
};

}  // namespace grinder
