#pragma once

#include <QDoubleSpinBox>
#include <QString>

#include <optional>

namespace grinder {

/// A box for a number with its unit. Point and comma are both the decimal sign, whatever the system's language, and
/// there is no group separator: 6,203 is 6.203, never 6203. An entry that is not a number in range stays as typed, in
/// red, until it is changed: call isGood() before using the value. Numbers are shown without trailing zeros.
class NumberBox : public QDoubleSpinBox {
  Q_OBJECT

 public:
  /// @param decimals number of decimals, at least one: a box of whole numbers would drop the decimal sign.
  NumberBox(const char* name, int decimals, QWidget* parent = nullptr);

  /// Whether the whole text is a number in range, and value() is that number, or will be once the box is left.
  bool isGood() const { return hasAcceptableInput(); }
  /// The allowed entries as text, e.g. "1 to 30 mm, 2 decimals".
  QString allowed() const;

  QValidator::State validate(QString& text, int& position) const override;
  double valueFromText(const QString& text) const override;
  QString textFromValue(double value) const override;
  void fixup(QString& text) const override;

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  QString entered(const QString& text) const;
  std::optional<double> number(const QString& text) const;
  template <typename Handle>
  void keepText(Handle handle);

  bool red_ = false;
};

}  // namespace grinder
