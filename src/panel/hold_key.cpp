#include "panel/hold_key.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QTextEdit>

namespace grinder {

namespace {

/// Whether a space can be typed into a widget; not into a number.
bool takesText(const QObject& widget) {
  if (const auto* line = qobject_cast<const QLineEdit*>(&widget)) {
    return !line->isReadOnly() && !qobject_cast<const QAbstractSpinBox*>(line->parent());
  }
  if (const auto* choice = qobject_cast<const QComboBox*>(&widget)) return choice->isEditable();
  if (const auto* text = qobject_cast<const QPlainTextEdit*>(&widget)) return !text->isReadOnly();
  const auto* text = qobject_cast<const QTextEdit*>(&widget);
  return text && !text->isReadOnly();
}

}  // namespace

HoldKey::HoldKey() { QApplication::instance()->installEventFilter(this); }

bool HoldKey::eventFilter(QObject* watched, QEvent* event) {
  // Accepted, a shortcut override keeps the key from the shortcuts of rviz's tools.
  const bool keys = event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress ||
                    event->type() == QEvent::KeyRelease;
  if (!keys || !watched->isWidgetType()) return false;
  const auto& key = static_cast<QKeyEvent&>(*event);
  if (key.key() != Qt::Key_Space || takesText(*watched)) return false;
  event->accept();
  if (event->type() != QEvent::KeyPress || key.isAutoRepeat()) return true;
  for (const auto& hold : holds_) {
    if (hold) hold->click();
  }
  return true;
}

}  // namespace grinder
