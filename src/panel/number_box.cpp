#include "panel/number_box.h"

#include "flute_grinder/base/format.h"
#include "panel/text_view.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QLineEdit>
#include <QRegularExpression>
#include <QToolTip>

namespace grinder {

namespace {

constexpr const char* kWrongPaper = "#fbe3e4";

}  // namespace

NumberBox::NumberBox(const char* name, int decimals, QWidget* parent) : QDoubleSpinBox(parent) {
  setObjectName(name);
  setDecimals(decimals);
  connect(lineEdit(), &QLineEdit::textChanged, this, QOverload<>::of(&QWidget::update));
}

QString NumberBox::allowed() const {
  return QString("%1 to %2%3, %4 decimals")
      .arg(textFromValue(minimum()), textFromValue(maximum()), suffix())
      .arg(decimals());
}

/// A text without prefix and suffix.
QString NumberBox::entered(const QString& text) const {
  QString rest = text;
  if (rest.startsWith(prefix())) rest.remove(0, prefix().size());
  if (rest.endsWith(suffix())) rest.chop(suffix().size());
  return rest;
}

/// The number in a text; nothing unless it is a number in range.
std::optional<double> NumberBox::number(const QString& text) const {
  const QRegularExpression plain(QString("^[-+]?([0-9]+([.,][0-9]{0,%1})?|[.,][0-9]{1,%1})$").arg(decimals()));
  const QString figures = entered(text).trimmed();
  if (!plain.match(figures).hasMatch()) return std::nullopt;
  const double value = QString(figures).replace(',', '.').toDouble();
  if (!(minimum() <= value && value <= maximum())) return std::nullopt;
  return value;
}

QValidator::State NumberBox::validate(QString& text, int& /*position*/) const {
  // If a part of the suffix was deleted, Qt adds the suffix to the rest.
  for (int part = 2; part < suffix().size(); ++part) {
    if (entered(text).endsWith(suffix().left(part))) return QValidator::Invalid;
  }
  return number(text) ? QValidator::Acceptable : QValidator::Intermediate;
}

double NumberBox::valueFromText(const QString& text) const { return number(text).value_or(value()); }

QString NumberBox::textFromValue(double value) const {
  static const QRegularExpression zeros("\\.?0*$");
  return QString::fromStdString(fixed(value, decimals())).remove(zeros);
}

void NumberBox::fixup(QString& /*text*/) const {}

bool NumberBox::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || isGood()) return QDoubleSpinBox::event(event);
  QToolTip::showText(static_cast<QHelpEvent*>(event)->globalPos(), "Allowed: " + allowed(), this);
  return true;
}

void NumberBox::keyPressEvent(QKeyEvent* event) {
  const bool enters = event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter;
  if (enters && !isGood()) return event->ignore();
  QDoubleSpinBox::keyPressEvent(event);
}

void NumberBox::focusOutEvent(QFocusEvent* event) {
  keepText([&] { QDoubleSpinBox::focusOutEvent(event); });
}

void NumberBox::hideEvent(QHideEvent* event) {
  keepText([&] { QDoubleSpinBox::hideEvent(event); });
}

/// Lets Qt handle an event, but keeps a wrong text that Qt would replace by the value.
template <typename Handle>
void NumberBox::keepText(Handle handle) {
  const QString text = lineEdit()->text();
  const bool good = isGood();
  handle();
  if (!good) lineEdit()->setText(text);
}

/// Sets the colour here, because Qt sends no signal for a text that it sets itself.
void NumberBox::paintEvent(QPaintEvent* event) {
  QDoubleSpinBox::paintEvent(event);
  if (red_ != isGood()) return;
  red_ = !red_;
  QPalette colours;
  if (red_) colours.setColor(QPalette::Text, QColor(kWrong));
  if (red_) colours.setColor(QPalette::Base, QColor(kWrongPaper));
  setPalette(colours);
}

}  // namespace grinder
