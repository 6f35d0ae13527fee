#pragma once

#include "flute_grinder/GrinderState.h"

#include <QLabel>
#include <QSlider>
#include <QTimer>
#include <QWidget>

#include <optional>

namespace flute_grinder {

/// The feed override: shows the grinder's, and asks for another one when the slider is let go of or rests.
class OverrideBox : public QWidget {
  Q_OBJECT

 public:
  explicit OverrideBox(QWidget* parent = nullptr);

  void refresh(const std::optional<GrinderState>& state);
  /// To be called for every wanted(): the grinder has what was asked for, or has refused it.
  void answered();
  /// No answers will come any more.
  void reset();

 Q_SIGNALS:
  void wanted(double fraction);  ///< of the job's feed

 private:
  void ask();

  QSlider* slider_;  ///< per cent
  QLabel* value_;
  QTimer rest_;
  int unanswered_ = 0;
  QTimer settle_;  ///< until a state has come that is newer than the answer
};

}  // namespace flute_grinder
