#pragma once

#include <QWidget>

namespace grinder {

/// Lets the mouse wheel change a box, a choice or a slider only if that has the focus, which the wheel does not give:
/// a wheel that is turned to scroll must not change what happens to be under the mouse.
/// @param parent of all of them that there are so far.
void guardFromWheel(QWidget& parent);

}  // namespace grinder
