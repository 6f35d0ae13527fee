#pragma once

#include <QWidget>

namespace grinder {

/// Lets the mouse wheel change a box, a choice or a slider only if it has the focus, which the wheel does not give it:
/// scrolling must not change what happens to be under the mouse.
/// @param parent parent of the widgets; covers those that exist so far.
void guardFromWheel(QWidget& parent);

}  // namespace grinder
