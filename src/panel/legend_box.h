#pragma once

#include "flute_grinder/Legend.h"

#include <QLabel>
#include <QWidget>

#include <array>
#include <optional>

namespace grinder {

/// The legend of rviz's colours: the ends of the scales, and the maximum error measured.
class LegendBox : public QWidget {
  Q_OBJECT

 public:
  explicit LegendBox(QWidget* parent = nullptr);
  /// @param legend nothing if no job is shown, or if the grinder does not answer.
  void show(const std::optional<flute_grinder::Legend>& legend);

 private:
  struct Scale {
    QLabel* title;
    QLabel* end;
  };

  QLabel* cutter_;
  std::array<Scale, 4> scales_{};
  QLabel* max_;
};

}  // namespace grinder
