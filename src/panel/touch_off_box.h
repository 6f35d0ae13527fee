#pragma once

#include "panel/grinder_link.h"
#include "panel/number_box.h"
#include "panel/question.h"

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QStackedLayout>
#include <QWidget>

#include <functional>

namespace grinder {

/// Sets the work offset of an axis from where it stands, takes the last one back, and takes the word of a new clamping;
/// shows the offset with who set it and when, and the tool in the collet. Nothing counts before the operator has seen
/// it beside what was.
class TouchOffBox : public QWidget {
  Q_OBJECT

 public:
  explicit TouchOffBox(QWidget* parent = nullptr);

  /// @param has_services whether requests with an answer can be sent.
  void refresh(const GrinderView& view, bool has_services);

  /// Asks before something counts; the question goes when the axis moves.
  /// @param done what to do if it is to count.
  void ask(const QString& text, const Comparison& figures, std::function<void()> done);

  /// The offset that was set last from here is taken back on demand. @param axis kAxisCount for none.
  void offerBack(int axis);

 Q_SIGNALS:
  /// @param at the axis' work position; of Y the diameter of the blank that the wheel touches [m], of A [rad].
  void wanted(int axis, double at);
  void backWanted();
  void reclampedWanted();

 private:
  int axis() const { return axis_->currentIndex(); }
  void chooseAxis();
  QString offsetText(const GrinderView& view) const;

  QComboBox* axis_;
  NumberBox* at_;  ///< [mm or deg]
  QPushButton* touch_;
  QPushButton* back_;
  QPushButton* reclamped_;
  QLabel* offset_;
  QLabel* tool_;
  Question* question_;
  QStackedLayout* pages_;       ///< all of the above or the question
  double position_ = 0;         ///< of the axis, as last received [m], A [rad]
  double asked_at_ = 0;         ///< of the axis, when the question was asked [m], A [rad]
  std::function<void()> done_;  ///< the answer to the question
  int back_axis_ = kAxisCount;  ///< whose offset can be taken back
};

}  // namespace grinder
