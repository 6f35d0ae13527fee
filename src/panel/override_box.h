#pragma once

#include "flute_grinder/GrinderState.h"

#include <QLabel>
#include <QSlider>
#include <QTimer>
#include <QWidget>

#include <optional>

namespace grinder {

/// Shows the grinder's feed override, and requests a new one when the slider is released or comes to rest.
class OverrideBox : public QWidget {
  Q_OBJECT

 public:
  explicit OverrideBox(QWidget* parent = nullptr);

  void refresh(const std::optional<flute_grinder::GrinderState>& state);
  /// To be called after every wanted(), when the grinder has accepted or refused the override.
  void answered();
  /// To be called when no more answers will come.
  void reset();

 Q_SIGNALS:
  void wanted(double fraction);  ///< fraction of the job's feed

 private:
  void emitWanted();

  QSlider* slider_;  ///< override in per cent
  QLabel* value_;
  QTimer rest_;
  int unanswered_ = 0;
  QTimer settle_;  ///< runs until a state newer than the answer has arrived
};

}  // namespace grinder
