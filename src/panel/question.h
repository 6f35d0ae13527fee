#pragma once

#include "panel/comparison.h"

#include <QPushButton>
#include <QTextEdit>
#include <QTimer>
#include <QWidget>

#include <functional>

class QGridLayout;
class QLabel;

namespace grinder {

/// Asks before something is done that the operator may not want: a text, and the answers below it in two columns, with
/// *Not yet*, which does nothing, in the same place in each. For a second after it has appeared it takes no answer,
/// since the click may be meant for what was there before, and until its end has been in sight none but *Not yet*: what
/// decides stands in the last line of the table. No key gives one.
class Question : public QWidget {
  Q_OBJECT

 public:
  /// @param name of the text is NAME_question, and of *Not yet* decline_NAME. @param lines of the text that have room.
  Question(const QString& name, int lines);

  /// @param row 0 or 1, column 0 or 1: not where the answer to a question that comes before this one lies. *Not yet*
  /// has (1, 1). @param act what the answer does, after answered().
  QPushButton* addAnswer(const char* name, const QString& text, const QString& hint, int row, int column,
                         const std::function<void()>& act);

  /// The same for an answer that costs a wheel or a tool if it is given by mistake, in a smaller button.
  QPushButton* addDanger(const char* name, const QString& text, const QString& hint, int row, int column,
                         const std::function<void()>& act);

  /// @param figures between which the answer decides, below the text.
  void ask(const QString& text, const Comparison& figures = {});

 Q_SIGNALS:
  /// By any answer, *Not yet* among them: the question is to go.
  void answered();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void appear();
  void enableAnswers();

  QTextEdit* text_;
  QPushButton* decline_ = nullptr;
  QLabel* more_;
  bool seen_ = false;  ///< its end, since it has appeared
  QGridLayout* layout_;
  QTimer appearing_;
};

}  // namespace grinder
