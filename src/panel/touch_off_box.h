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

/// Sets the work offset of an axis from where it stands, and shows the offset with who set it and when.
class TouchOffBox : public QWidget {
  Q_OBJECT

 public:
  explicit TouchOffBox(QWidget* parent = nullptr);

  /// @param has_services whether requests with an answer can be sent.
  void refresh(const GrinderView& view, bool has_services);

  /// Asks whether to set the offset all the same; the question goes when the axis moves.
  void ask(const QString& why_not, std::function<void()> all_the_same);

 Q_SIGNALS:
  /// @param at the axis' work position; of Y the diameter of the blank that the wheel touches [m], of A [rad].
  void wanted(int axis, double at);

 private:
  int axis() const { return axis_->currentIndex(); }
  void chooseAxis();
  QString offsetText(const GrinderView& view) const;

  QComboBox* axis_;
  NumberBox* at_;  ///< [mm or deg]
  QPushButton* touch_;
  QLabel* offset_;
  Question* question_;
  QStackedLayout* pages_;               ///< all of the above or the question
  double position_ = 0;                 ///< of the axis, as last received [m], A [rad]
  double asked_at_ = 0;                 ///< of the axis, when the question was asked [m], A [rad]
  std::function<void()> all_the_same_;  ///< the answer to the question
};

}  // namespace grinder
