#include "panel/legend_box.h"

#include "flute_grinder/base/units.h"
#include "flute_grinder/scene/markers.h"
#include "panel/text_view.h"

#include <QGridLayout>
#include <QPainter>
#include <QRegularExpression>

namespace grinder {

namespace {

using namespace units;

constexpr int kDigits = 3;  ///< digits of a figure
constexpr int kStops = 16;  ///< stops of the gradient

/// The colours from 0 to a scale's end.
class Gradient : public QWidget {
 public:
  Gradient() { setFixedHeight(fontMetrics().ascent()); }

 protected:
  void paintEvent(QPaintEvent* /*event*/) override {
    QLinearGradient gradient(0, 0, width(), 0);
    for (int i = 0; i <= kStops; ++i) {
      const double at = static_cast<double>(i) / kStops;
      const std_msgs::ColorRGBA c = errorColour(at);
      gradient.setColorAt(at, QColor::fromRgbF(c.r, c.g, c.b));
    }
    QPainter(this).fillRect(rect(), gradient);
  }
};

QString micrometres(double length) { return QString("%1 um").arg(length / kMicrometre, 0, 'g', kDigits); }
QString degrees(double angle) { return QString("%1 deg").arg(angle / kDegree, 0, 'g', kDigits); }

/// The magnification of the arrows, e.g. " x 500" or " x 5e6"; empty without arrows.
QString timesText(double scale) {
  if (!(scale > 0)) return "";
  return " x " + QString::number(scale, 'g', 3).replace(QRegularExpression("e\\+0*"), "e");
}

}  // namespace

LegendBox::LegendBox(QWidget* parent)
    : QWidget(parent), cutter_(namedLabel("shown_cutter")), max_(namedLabel("max_error")) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setVerticalSpacing(4);
  layout->setColumnStretch(1, 1);
  cutter_->setWordWrap(true);
  cutter_->setMinimumHeight(2 * cutter_->fontMetrics().lineSpacing());
  layout->addWidget(cutter_, 0, 0, 1, 3);
  constexpr std::array<std::array<const char*, 2>, 4> names{{{"flutes", "flutes_end"},
                                                             {"rake_faces", "rake_faces_end"},
                                                             {"reliefs", "reliefs_end"},
                                                             {"arrows", "arrows_end"}}};
  constexpr std::array<const char*, 4> hints{
      "Lines along the flutes: the maximum error measured in the last finished pass",
      "Faces of the ground cutter: how far their rake is from the one asked",
      "Primary reliefs of the ground cutter: how far their clearance is from the one asked",
      "Arrows across the flute: path error of the setpoints, drawn this many times longer"};
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    scales_[i] = {namedLabel(names[i][0]), namedLabel(names[i][1])};
    scales_[i].title->setToolTip(hints[i]);
    const int row = static_cast<int>(i) + 1;
    layout->addWidget(scales_[i].title, row, 0);
    layout->addWidget(new Gradient, row, 1);
    layout->addWidget(scales_[i].end, row, 2);
  }
  max_->setToolTip("Of the path, measured normal to the helix on the cutter's surface");
  layout->addWidget(max_, 5, 0, 1, 3);
  auto* lines = namedLabel("line_colours");
  lines->setText("Red: out of tolerance. Flutes: grey planned, magenta now. Cyan: wheel's path.");
  lines->setWordWrap(true);
  layout->addWidget(lines, 6, 0, 1, 3);
  show(std::nullopt);
}

void LegendBox::show(const std::optional<flute_grinder::Legend>& legend) {
  setEnabled(legend.has_value());
  const auto set = [&](std::size_t i, const QString& title, const QString& end) {
    scales_[i].title->setText(title);
    scales_[i].end->setText(legend ? end : "-");
  };
  if (!legend) {
    cutter_->setText("No job is shown.");
    set(0, "Measured error", "");
    set(1, "Rake error", "");
    set(2, "Clearance error", "");
    set(3, "Path error", "");
    max_->clear();
    return;
  }
  const flute_grinder::Cutter& cutter = legend->cutter;
  cutter_->setText(QString::fromStdString(legend->shown));
  set(0, "Measured error", micrometres(legend->tolerance));
  set(1, "Rake error, off " + degrees(cutter.rake_angle), degrees(cutter.rake_tolerance));
  const bool relieved = cutter.clearance > 0;
  set(2, "Clearance error" + (relieved ? ", off " + degrees(cutter.clearance) : ""),
      relieved ? degrees(cutter.clearance_tolerance) : "-");
  set(3, "Path error" + timesText(legend->arrow_scale), micrometres(legend->tolerance));
  max_->setText("Maximum error measured: " + micrometres(legend->max_error));
}

}  // namespace grinder
