#pragma once

#include <QRect>
#include <QScreen>
#include <QWidget>
#include <QWindow>

#include <algorithm>

namespace grinder {

/// Moves a window beside the panel, to the side with more room, and makes it narrow enough for that room, so that it
/// never covers the buttons that stop the grinder. @param part a part of the panel that is as wide as the panel.
inline void moveBeside(QWidget& window, const QWidget& part) {
  constexpr int apart = 30;  // for the panel's margin and the window's frame [px]
  const QRect here(part.mapToGlobal(QPoint()), part.size());
  const QRect screen = part.window()->windowHandle()->screen()->availableGeometry();
  const int left = here.left() - screen.left() - apart, right = screen.right() - here.right() - apart;
  const QSize wanted = window.size().expandedTo(window.sizeHint());
  window.resize(wanted.boundedTo(QSize(std::max(left, right), screen.height() - apart)));
  const int lowest = std::max(screen.top(), screen.bottom() - apart - window.height());
  window.move(right > left ? here.right() + apart : here.left() - apart - window.width(), std::min(here.top(), lowest));
}

}  // namespace grinder
