#pragma once

#include <QAbstractButton>
#include <QObject>
#include <QPointer>

#include <vector>

namespace grinder {

/// Makes Space press Hold in all windows of the program, whatever has the focus. It is an ordinary space only where
/// text is typed, as in the name of a file. All panels of the program share one object.
class HoldKey : public QObject {
 public:
  HoldKey();

  /// @param hold button to press, along with all other enabled ones.
  void add(QAbstractButton& hold) { holds_.emplace_back(&hold); }

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  std::vector<QPointer<QAbstractButton>> holds_;  ///< buttons; null if the panel is gone
};

}  // namespace grinder
