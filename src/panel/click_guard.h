#pragma once

#include <QWidget>

#include <set>

namespace grinder {

/// Makes a double click press a button once. By the second click another button may lie under the mouse, and the same
/// button would act twice.
/// @param parent parent of the buttons, including buttons in its dialogs. @param always buttons that take every click.
void guardFromDoubleClicks(QWidget& parent, const std::set<QWidget*>& always);

}  // namespace grinder
