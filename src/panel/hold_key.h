#pragma once

#include <QAbstractButton>
#include <QObject>
#include <QPointer>

#include <vector>

namespace grinder {

/// Space is Hold in all windows of the program, whatever has the focus, and does nothing else. Only where a text is
/// typed, as in the name of a file, is it a space. One for the program, however many panels there are.
class HoldKey : public QObject {
 public:
  HoldKey();

  /// @param hold is pressed with all the others that are enabled.
  void add(QAbstractButton& hold) { holds_.emplace_back(&hold); }

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  std::vector<QPointer<QAbstractButton>> holds_;  ///< null if the panel is gone
};

}  // namespace grinder
