#pragma once

#include "flute_grinder/GrindGoal.h"
#include "flute_grinder/machine/swivel.h"

#include <QLabel>
#include <QWidget>

namespace flute_grinder {

/// Whether the operator must confirm the swivel before a goal is started. Never if the drive measures it: if it does
/// not stand where it should, the grinder refuses the goal.
bool needsConfirmation(const GrindGoal& goal, const Swivel& swivel);

/// Asks whether the swivel is set to the angle of the job to be started.
class SwivelQuestion : public QWidget {
  Q_OBJECT

 public:
  explicit SwivelQuestion(QWidget* parent = nullptr);

  /// @param angle of the job [rad].
  void ask(double angle);

 Q_SIGNALS:
  void confirmed(double angle);  ///< as asked [rad]
  void declined();

 private:
  double angle_ = 0;
  QLabel* text_;
};

}  // namespace flute_grinder
