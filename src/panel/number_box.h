#pragma once

#include <QDoubleSpinBox>

namespace flute_grinder {

/// A box for a number with its unit. Point and comma are both the decimal sign, whatever the system's language, and
/// there is no group separator: 6,203 is 6.203, never 6203. What is not a number is not taken. Shown without zeros at
/// the end.
class NumberBox : public QDoubleSpinBox {
  Q_OBJECT

 public:
  /// @param decimals that can be entered, at least one: a box of whole numbers would drop the decimal sign.
  NumberBox(const char* name, int decimals, QWidget* parent = nullptr);

  QValidator::State validate(QString& text, int& position) const override;
  double valueFromText(const QString& text) const override;
  QString textFromValue(double value) const override;
};

}  // namespace flute_grinder
