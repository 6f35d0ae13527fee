#pragma once

#include "flute_grinder/client/grinder_client.h"
#include "panel/number_box.h"
#include "panel/question.h"

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QStackedLayout>
#include <QWidget>

#include <functional>

namespace grinder {

/// Sets the work offset of an axis from its present position, takes the last change back, and reports a new clamping.
/// Shows the offset with who set it and when, and the tool in the collet. A change counts only after the operator has
/// seen it beside the old value.
class TouchOffBox : public QWidget {
  Q_OBJECT

 public:
  explicit TouchOffBox(QWidget* parent = nullptr);

  /// @param has_services whether requests with an answer can be sent. @param has_job whether a job is chosen.
  void refresh(const GrinderView& view, bool has_services, bool has_job);

  /// Whether the grinder can set offsets in its present state.
  static bool maySet(const GrinderView& view);

  /// Asks before a change counts; the question disappears when the axis moves.
  /// @param done action if the operator agrees.
  void ask(const QString& text, const Comparison& figures, const std::function<void()>& done);
  /// Asks what the grinder needs to be told; disappears in the same way. @param answered gets the id of the answer.
  void ask(const flute_grinder::Need& need, const std::function<void(const std::string& id)>& answered);

  /// Offers to take back the last offset set by this panel. @param axis kAxisCount for none.
  void offerBack(int axis);

 Q_SIGNALS:
  /// @param at work position of the axis [m], A [rad]; for Y, diameter of the blank that the wheel touches [m].
  void wanted(int axis, double at);
  void backWanted();
  void reclampedWanted();
  void measuredWanted();

 private:
  int axis() const { return axis_->currentIndex(); }
  void chooseAxis();
  QString offsetText(const GrinderView& view) const;
  void showQuestion();

  QComboBox* axis_;
  NumberBox* at_;  ///< position or diameter [mm or deg]
  QPushButton* touch_;
  QPushButton* back_;
  QPushButton* reclamped_;
  QPushButton* measured_;
  QLabel* offset_;
  QLabel* tool_;
  Question* question_;
  QStackedLayout* pages_;       ///< all widgets above, or the question
  double position_ = 0;         ///< last position of the axis received [m], A [rad]
  double asked_at_ = 0;         ///< position of the axis when the question was asked [m], A [rad]
  int back_axis_ = kAxisCount;  ///< axis whose offset can be taken back
};

}  // namespace grinder
