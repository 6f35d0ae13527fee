#pragma once

#include <QRect>
#include <QScreen>
#include <QWidget>
#include <QWindow>

#include <algorithm>

namespace flute_grinder {

/// Moves a window beside a part of the panel that is as wide as the panel, to where there is more room, and makes it so
/// narrow that it has room there: the buttons that stop the grinder are never below it.
inline void moveBeside(QWidget& window, const QWidget& part) {
  constexpr int kApart = 30;  // for the panel's margin and the window's frame [px]
  const QRect here(part.mapToGlobal(QPoint()), part.size());
  const QRect screen = part.window()->windowHandle()->screen()->availableGeometry();
  const int left = here.left() - screen.left() - kApart, right = screen.right() - here.right() - kApart;
  const QSize wanted = window.size().expandedTo(window.sizeHint());
  window.resize(wanted.boundedTo(QSize(std::max(left, right), screen.height() - kApart)));
  const int lowest = std::max(screen.top(), screen.bottom() - kApart - window.height());
  window.move(right > left ? here.right() + kApart : here.left() - kApart - window.width(),
              std::min(here.top(), lowest));
}

}  // namespace flute_grinder
