#include "panel/section_drawing.h"

#include "panel/end_drawing.h"
#include "panel/text_view.h"

#include <QPainter>
#include <QStringList>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

using namespace units;

const QColor kPaper("#ffffff");
const QColor kBody("#d3dbe4");
const QColor kInk("#202124");
const QColor kThin("#5f6368");
const QColor kMeasured("#1a5fb4");

constexpr int kLines = 2;          ///< lines of a label; a relief's label has one more
constexpr double kDimension = 8;   ///< distance from the cutter to the land's dimension [px]
constexpr double kMargin = 14;     ///< margin around the cutter [px]
constexpr double kStepsOfQt = 16;  ///< Qt's units of angle per degree
constexpr double kTop = kPi / 2;   ///< angle at which the first tooth's edge is drawn [rad]

QPen dashed(const QColor& colour) { return {colour, 1, Qt::DashLine}; }

/// One painting of a section.
class Painting {
 public:
  Painting(QPainter& painter, const CutterSection& section, const QRectF& sheet)
      : painter_(painter), section_(section), sheet_(sheet), centre_(sheet.center()) {
    const QFontMetricsF metrics(painter.font());
    label_ = {metrics.horizontalAdvance("asked 00.00"),
              (kLines + (isRelief(section.job->process().kind) ? 1 : 0)) * metrics.lineSpacing()};
    // The corners are for the labels.
    const double w = sheet.width() / 2, h = sheet.height() / 2;
    const double corner = std::hypot(std::max(0.0, w - label_.width()), std::max(0.0, h - label_.height()));
    radius_ = std::max(10.0, std::min({w, h, corner}) - kMargin);
    scale_ = radius_ / section.ground.radius;
    const ToothSection& first = section.ground.teeth.front();
    turn_ = kTop - first.edge.value_or(0);
    side_ = section.job->cutter.cut == CutDirection::kRightHand ? 1 : -1;
  }

  void paint() {
    body();
    circles();
    const ToothSection& first = section_.ground.teeth.front();
    if (first.rake) rake(first);
    if (isRelief(section_.job->process().kind)) {
      if (first.relief && first.relief->clearance) relief(*first.relief);
    } else if (first.land) {
      land(*first.land);
    } else if (first.flute)
      label(-side_, -1, {"no land"}, false, at(section_.ground.radius, kTop));
  }

 private:
  /// A point on the sheet. @param angle angle on the sheet [rad]
  QPointF at(double radius, double angle) const {
    return centre_ + scale_ * radius * QPointF(std::cos(angle), -std::sin(angle));
  }

  void circle(double radius, const QPen& pen) {
    painter_.setPen(pen);
    painter_.drawEllipse(centre_, scale_ * radius, scale_ * radius);
  }

  void body() {
    QPolygonF outline;
    for (const PolarPoint& point : section_.outline) outline << at(point.radius, point.angle() + turn_);
    painter_.setPen(QPen(kInk, 1.5));
    painter_.setBrush(kBody);
    painter_.drawPolygon(outline);
    painter_.setBrush(Qt::NoBrush);
  }

  void circles() {
    const double ground = section_.ground.core_radius;
    circle(section_.ground.radius, QPen(kThin, 1));
    circle(section_.asked_core, dashed(kThin));
    circle(ground, QPen(kMeasured, 1));
    label(1, 1, {"core", mm(2 * ground) + " mm"}, section_.isWithin(ToolFigure::kCoreDiameter), at(ground, -kPi / 4));
    label(-1, 1, {"cutter", mm(2 * section_.ground.radius) + " mm"}, true, at(section_.ground.radius, -3 * kPi / 4));
  }

  /// Draws the rake: the angle at the edge between the radius and the rake face's tangent.
  void rake(const ToothSection& tooth) {
    const QPointF edge = at(section_.ground.radius, kTop);
    const auto inward = [&](double angle) { return QPointF(-side_ * std::sin(angle), std::cos(angle)); };
    painter_.setPen(dashed(kThin));
    painter_.drawLine(edge, edge + 0.95 * radius_ * inward(section_.job->cutter.rake_angle));
    painter_.setPen(QPen(kThin, 1));
    painter_.drawLine(edge - kDimension * inward(0), centre_);
    const QColor colour = section_.isWithin(ToolFigure::kRake) ? kMeasured : QColor(kWrong);
    painter_.setPen(QPen(colour, 1.5));
    painter_.drawLine(edge - kDimension * inward(*tooth.rake), edge + 0.95 * radius_ * inward(*tooth.rake));
    const double r = 0.8 * radius_;
    arc(edge, r, -kTop, -side_ * *tooth.rake);
    label(side_, -1, {deg(*tooth.rake) + " deg", "asked " + deg(section_.job->cutter.rake_angle)},
          section_.isWithin(ToolFigure::kRake), edge + r * inward(*tooth.rake / 2));
  }

  /// Draws the primary relief: its angle at the edge to the circle's tangent, and its width.
  void relief(const ReliefSection& relief) {
    const QPointF edge = at(section_.ground.radius, kTop);
    const auto behind = [&](double angle) { return QPointF(-side_ * std::cos(angle), std::sin(angle)); };
    painter_.setPen(QPen(kThin, 1));
    painter_.drawLine(edge, edge + 0.95 * radius_ * behind(0));
    painter_.setPen(dashed(kThin));
    painter_.drawLine(edge, edge + 0.95 * radius_ * behind(section_.job->cutter.clearance));
    const bool good = section_.isWithin(ToolFigure::kClearance);
    painter_.setPen(QPen(good ? kMeasured : QColor(kWrong), 1.5));
    painter_.drawLine(edge, edge + 0.95 * radius_ * behind(*relief.clearance));
    const double r = 0.75 * radius_;
    arc(edge, r, side_ > 0 ? kPi : 0, side_ * *relief.clearance);
    QStringList lines{deg(*relief.clearance) + " deg", "asked " + deg(section_.job->cutter.clearance)};
    if (relief.land) {
      lines << QString::number(*relief.land / kMillimetre, 'f', 2) + " mm";
      alongCircle(*relief.land / section_.ground.radius);
    }
    label(-side_, -1, lines, good, edge + r * behind(*relief.clearance / 2));
  }

  /// Draws a dimension outside the cutter. @param angle angle behind the edge [rad].
  void alongCircle(double angle) {
    const double outside = radius_ + kDimension;
    painter_.setPen(QPen(kMeasured, 1.5));
    arc(centre_, outside, kTop, side_ * angle);
    for (const double end : {kTop, kTop + side_ * angle}) {
      painter_.drawLine(at(section_.ground.radius, end), at((outside + 4) / scale_, end));
    }
  }

  void land(double land) {
    const double outside = radius_ + kDimension;
    alongCircle(land);
    const double target = kTop + side_ * std::min(land / 2, kPi / 4);
    label(-side_, -1,
          {deg(land) + " deg", QString::number(land * section_.ground.radius / kMillimetre, 'f', 2) + " mm"}, true,
          at(outside / scale_, target));
  }

  /// Draws an arc. @param from,span counterclockwise [rad]
  void arc(const QPointF& centre, double radius, double from, double span) {
    const QRectF square(centre - QPointF(radius, radius), 2 * QSizeF(radius, radius));
    painter_.drawArc(square, qRound(from / kDegree * kStepsOfQt), qRound(span / kDegree * kStepsOfQt));
  }

  /// Writes a label into a corner, with a line to its target.
  /// @param right,low 1 or -1: the corner.
  void label(double right, double low, const QStringList& lines, bool good, const QPointF& target) {
    const int flags = (right > 0 ? Qt::AlignRight : Qt::AlignLeft) | (low > 0 ? Qt::AlignBottom : Qt::AlignTop);
    const QString text = lines.join('\n');
    const QRectF box = painter_.boundingRect(sheet_, flags, text);
    const QPointF inner(right > 0 ? box.left() : box.right(), low > 0 ? box.top() : box.bottom());
    painter_.setPen(QPen(kThin, 0.7));
    painter_.drawLine(inner, target);
    painter_.setBrush(kThin);
    painter_.drawEllipse(target, 1.5, 1.5);
    painter_.setBrush(Qt::NoBrush);
    painter_.setPen(good ? kInk : QColor(kWrong));
    painter_.drawText(box, flags, text);
  }

  static QString mm(double length) { return QString::number(length / kMillimetre, 'f', 3); }
  static QString deg(double angle) { return QString::number(angle / kDegree, 'f', 2); }

  QPainter& painter_;
  const CutterSection& section_;
  QRectF sheet_;
  QPointF centre_;
  QSizeF label_;
  double radius_, scale_, turn_;  ///< cutter [px], [px/m], from the cutter's frame to the sheet [rad]
  double side_;                   ///< side of the edge with its flute: 1 right, -1 left
};

}  // namespace

SectionDrawing::SectionDrawing(QWidget* parent) : QWidget(parent) { setSection(nullptr); }

void SectionDrawing::setSection(std::shared_ptr<const CutterSection> section) {
  section_ = std::move(section);
  // The legend of an end has up to eight lines.
  setMinimumHeight((section_ && section_->end ? 9 : 5) * fontMetrics().lineSpacing());
  setToolTip(section_ && section_->end ? "The end, seen along the axis; the first tooth's edge is at the top"
                                       : "Seen from the shank, turned until the first tooth's edge is at the top");
  update();
}

void SectionDrawing::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), kPaper);
  const QRectF sheet = QRectF(rect()).adjusted(3, 2, -3, -2);
  if (!section_) return;
  if (section_->end) return paintEnd(painter, sheet, section_->job, *section_->end);
  Painting(painter, *section_, sheet).paint();
}

}  // namespace grinder
