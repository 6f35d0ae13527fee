#include "panel/end_drawing.h"

#include <QPainterPath>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace grinder {

namespace {

constexpr double kSwatch = 10;  ///< size of a colour in the legend [px]
constexpr double kGap = 5;      ///< between a colour, its name, and the view [px]
const QColor kLine("#202124");
const QColor kFluteColour("#5c6b84");

/// A face of the end, with its colour as in a report.
struct FaceRow {
  SurfaceKind kind;
  const char* name;
  QColor colour;
};
const std::vector<FaceRow>& faces() {
  static const std::vector<FaceRow> rows{{SurfaceKind::kEndPrimary, "primary", "#e6edf5"},
                                         {SurfaceKind::kEndSecondary, "secondary", "#b9c6d6"},
                                         {SurfaceKind::kChamfer, "chamfer", "#e0c978"},
                                         {SurfaceKind::kGash, "gash", "#8d9bb0"},
                                         {SurfaceKind::kEndFace, "blank", "#a9a591"}};
  return rows;
}
const FaceRow& faceOf(SurfaceKind kind) {
  const auto& rows = faces();
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const FaceRow& row) { return row.kind == kind; });
  return found == rows.end() ? rows.back() : *found;
}

/// Writes a line of the legend at the left edge, below the last one. @param mark draws its mark into a square.
void legendLine(QPainter& painter, QRectF& free, const QString& name, const std::function<void(const QRectF&)>& mark) {
  const double height = painter.fontMetrics().lineSpacing();
  painter.setPen(QPen(kLine, 0.7));
  mark(QRectF(free.left(), free.top() + (height - kSwatch) / 2, kSwatch, kSwatch));
  painter.setPen(kLine);
  painter.drawText(QPointF(free.left() + kSwatch + kGap, free.top() + painter.fontMetrics().ascent()), name);
  free.setTop(free.top() + height);
}

/// A circle about the axis that limits edges.
struct Limit {
  double diameter;  ///< 0: none [m]
  const char* words;
  Qt::PenStyle style;
};

void paintLegend(QPainter& painter, QRectF free, const EndView& end, const std::vector<Limit>& limits) {
  const auto filled = [&](const QColor& colour) {
    return [&painter, colour](const QRectF& square) {
      painter.setBrush(colour);
      painter.drawRect(square);
    };
  };
  for (const FaceRow& face : faces()) {
    const auto is_it = [&](const EndRegion& region) { return &faceOf(region.kind) == &face; };
    if (std::any_of(end.regions.begin(), end.regions.end(), is_it)) {
      legendLine(painter, free, face.name, filled(face.colour));
    }
  }
  legendLine(painter, free, "flute", filled(kFluteColour));
  const auto line = [&](const QPen& pen) {
    return [&painter, pen](const QRectF& square) {
      painter.setPen(pen);
      painter.drawLine(QPointF(square.left(), square.center().y()), QPointF(square.right(), square.center().y()));
    };
  };
  if (!end.edges.empty()) legendLine(painter, free, "edge", line(QPen(kLine, 2)));
  for (const Limit& limit : limits) {
    if (!(limit.diameter > 0)) continue;
    legendLine(painter, free, limit.words + QString::number(limit.diameter / units::kMillimetre),
               line(QPen(kLine, 1, limit.style)));
  }
}

}  // namespace

void paintEnd(QPainter& painter, const QRectF& sheet, const ValidJob& job, const EndView& end) {
  const double radius = job->cutter.end_diameter / 2;
  const std::vector<Limit> limits{{job->cutter.end_uncut_diameter, "uncut D ", Qt::DashLine},
                                  {2 * job->cutter.end_short_from, "short from D ", Qt::DotLine}};
  paintLegend(painter, sheet, end, limits);
  const double legend = kSwatch + 2 * kGap + painter.fontMetrics().horizontalAdvance("short from D 0.00");
  const QRectF place = sheet.adjusted(legend, 0, 0, 0);
  const double scale = 0.97 * std::min(place.width(), place.height()) / 2 / radius;
  const double edge = job->tooth_angles.front() + job.edges().front().at_end - units::kPi / 2;
  const double cos = std::cos(edge), sin = std::sin(edge);
  // Z up and Y to the left, as seen when looking at the end.
  const auto at = [&](const Eigen::Vector2d& p) {
    return place.center() + scale * QPointF(-p.x() * cos - p.y() * sin, p.x() * sin - p.y() * cos);
  };
  const auto circle = [&](double r) { painter.drawEllipse(place.center(), scale * r, scale * r); };
  const auto polygon = [&](const EndPolyline& line) {
    QPolygonF points;
    for (const Eigen::Vector2d& point : line) points << at(point);
    return points;
  };
  painter.setPen(QPen(kLine, 1));
  painter.setBrush(kFluteColour);
  circle(radius);
  painter.setPen(QPen(kLine, 0.5));
  for (const EndRegion& region : end.regions) {
    QPainterPath path;
    for (const EndPolyline& outline : region.outlines) path.addPolygon(polygon(outline)), path.closeSubpath();
    painter.setBrush(faceOf(region.kind).colour);
    painter.drawPath(path);
  }
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(kLine, 2));
  for (const EndEdge& line : end.edges) painter.drawPolyline(polygon(line.line));
  for (const Limit& limit : limits) {
    painter.setPen(QPen(kLine, 1, limit.style));
    if (limit.diameter > 0) circle(limit.diameter / 2);
  }
}

}  // namespace grinder
