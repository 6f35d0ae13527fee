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

/// A question before an action that the operator may not want: a text, and the answers below it in two columns, with
/// *Not yet*, which does nothing, always in the same place. For a second after it appears it takes no answer, because
/// the click may be meant for what was there before. Until its end has been in sight it takes only *Not yet*, because
/// the deciding figures may be in the last line. No key gives an answer.
class Question : public QWidget {
  Q_OBJECT

 public:
  /// @param name names the text NAME_question and *Not yet* decline_NAME. @param lines lines of text that have room.
  Question(const QString& name, int lines);

  /// @param row,column 0 or 1, but not the place of an answer to the question before this one. *Not yet* has (1, 1).
  /// @param act action of the answer, after answered().
  QPushButton* addAnswer(const char* name, const QString& text, const QString& hint, int row, int column,
                         const std::function<void()>& act);

  /// As addAnswer(), in a smaller button, for an answer that costs a wheel or a tool if it is given by mistake.
  QPushButton* addDanger(const char* name, const QString& text, const QString& hint, int row, int column,
                         const std::function<void()>& act);

  /// @param figures figures below the text, on which the answer depends.
  void ask(const QString& text, const Comparison& figures = {});

 Q_SIGNALS:
  /// An answer was given, perhaps *Not yet*: the question is to be hidden.
  void answered();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void appear();
  void enableAnswers();

  QTextEdit* text_;
  QPushButton* decline_ = nullptr;
  QLabel* more_;
  bool seen_ = false;  ///< its end has been in sight since it appeared
  QGridLayout* layout_;
  QTimer appearing_;
};

}  // namespace grinder
