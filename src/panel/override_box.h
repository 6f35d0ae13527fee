#pragma once

#include "flute_grinder/GrinderState.h"

#include <QLabel>
#include <QSlider>
#include <QTimer>
#include <QWidget>

#include <optional>

namespace grinder {

/// The feed override: shows the grinder's, and requests a new one when the slider is released or comes to rest.
class OverrideBox : public QWidget {
  Q_OBJECT

 public:
  explicit OverrideBox(QWidget* parent = nullptr);

  void refresh(const std::optional<flute_grinder::GrinderState>& state);
  /// To be called after every wanted(): the grinder has accepted or refused it.
  void answered();
  /// No more answers will come.
  void reset();

 Q_SIGNALS:
  void wanted(double fraction);  ///< of the job's feed

 private:
  void emitWanted();

  QSlider* slider_;  ///< per cent
  QLabel* value_;
  QTimer rest_;
  int unanswered_ = 0;
  QTimer settle_;  ///< until a state newer than the answer has arrived
};

}  // namespace grinder
