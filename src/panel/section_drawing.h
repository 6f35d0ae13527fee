#pragma once

#include "panel/cutter_section.h"

#include <QWidget>

#include <memory>

namespace grinder {

/// Draws a section of the ground cutter, seen from the shank and turned until the first tooth's edge is at the top, or
/// its end. In a section the first tooth's rake and land, the core and the cutter's diameter are dimensioned; the
/// values asked for are dashed.
class SectionDrawing : public QWidget {
  Q_OBJECT

 public:
  explicit SectionDrawing(QWidget* parent = nullptr);

  void setSection(std::shared_ptr<const CutterSection> section);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::shared_ptr<const CutterSection> section_;
};

}  // namespace grinder
