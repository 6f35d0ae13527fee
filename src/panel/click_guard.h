#pragma once

#include <QWidget>

#include <set>

namespace grinder {

/// Lets a double click press a button once: what lies under the mouse by the second click may be another button, which
/// the operator has not chosen, and the same one would do its work twice.
/// @param parent of the buttons, also of those in its dialogs. @param always buttons that take every click.
void guardFromDoubleClicks(QWidget& parent, const std::set<QWidget*>& always);

}  // namespace grinder
