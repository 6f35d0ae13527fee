#include "panel/number_box.h"

#include <QLocale>
#include <QRegularExpression>

namespace flute_grinder {

NumberBox::NumberBox(const char* name, int decimals, QWidget* parent) : QDoubleSpinBox(parent) {
  setObjectName(name);
  setDecimals(decimals);
  QLocale plain = QLocale::c();
  plain.setNumberOptions(QLocale::OmitGroupSeparator | QLocale::RejectGroupSeparator);
  setLocale(plain);
}

QValidator::State NumberBox::validate(QString& text, int& position) const {
  static const QRegularExpression plain("^[-+]?[0-9]*\\.?[0-9]*$");
  text.replace(',', '.');
  QString number = text;
  if (number.startsWith(prefix())) number.remove(0, prefix().size());
  if (number.endsWith(suffix())) number.chop(suffix().size());
  // Qt would take an exponent.
  if (!plain.match(number.trimmed()).hasMatch()) return QValidator::Invalid;
  return QDoubleSpinBox::validate(text, position);
}

double NumberBox::valueFromText(const QString& text) const {
  return QDoubleSpinBox::valueFromText(QString(text).replace(',', '.'));
}

QString NumberBox::textFromValue(double value) const {
  static const QRegularExpression zeros("\\.?0*$");
  const QString text = QString::number(value, 'f', decimals()).remove(zeros);
  return text == "-0" ? "0" : text;
}

}  // namespace flute_grinder
