#include "panel/lamp_box.h"

#include "panel/text_view.h"

#include <QHBoxLayout>

#include <array>

namespace grinder {

namespace {

enum class Lamp { kOff, kHalf, kLit };

QLabel* lamp(const char* name, const char* longest) {
  QLabel* made = namedLabel(name);
  QFont small = made->font();
  small.setPointSize(small.pointSize() - 1);
  made->setFont(small);
  // Fixed width, so that a change of the text moves nothing.
  made->setMinimumWidth(made->fontMetrics().horizontalAdvance(QString::fromUtf8("\xe2\x97\x8f ") + longest) + 2);
  return made;
}

void show(QLabel& label, Lamp lamp, const char* text) {
  constexpr std::array circles{"\xe2\x97\x8b", "\xe2\x97\x90", "\xe2\x97\x8f"};
  constexpr std::array colours{"", kAmber, kGreen};
  const auto i = static_cast<std::size_t>(lamp);
  label.setText(QString::fromUtf8(circles[i]) + ' ' + text);
  const QString style = lamp == Lamp::kOff ? QString() : QString("color: %1;").arg(colours[i]);
  if (style != label.styleSheet()) label.setStyleSheet(style);  // setStyleSheet() is slow
}

/// The lamp for a command and the drive's report.
Lamp lampOf(bool commanded, bool reported) {
  if (commanded != reported) return Lamp::kHalf;
  return commanded ? Lamp::kLit : Lamp::kOff;
}

}  // namespace

LampBox::LampBox(QWidget* parent)
    : QWidget(parent),
      spindle_(lamp("spindle_lamp", "Spindle at speed")),
      coolant_(lamp("coolant_lamp", "Coolant asked")),
      probe_(lamp("probe_lamp", "Probe touches")) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  for (QLabel* label : {spindle_, coolant_, probe_}) layout->addWidget(label, 1);
  setFixedHeight(fontMetrics().height() + 2);
}

void LampBox::show(const GrinderView& view) {
  const bool known = view.state && view.machine;
  spindle_->setVisible(known && view.machine->spindle);
  coolant_->setVisible(known && view.machine->coolant);
  probe_->setVisible(known && view.machine->probe);
  if (!known) return;
  const flute_grinder::GrinderState& s = *view.state;
  grinder::show(*spindle_, lampOf(s.spindle_commanded, s.spindle_at_speed),
                s.spindle_at_speed    ? (s.spindle_commanded ? "Spindle at speed" : "Spindle turns")
                : s.spindle_commanded ? "Spindle runs up"
                                      : "Spindle off");
  grinder::show(*coolant_, lampOf(s.coolant_commanded, s.coolant_on),
                s.coolant_on          ? (s.coolant_commanded ? "Coolant on" : "Coolant flows")
                : s.coolant_commanded ? "Coolant asked"
                                      : "Coolant off");
  grinder::show(*probe_, s.probe_contact ? Lamp::kLit : Lamp::kOff, s.probe_contact ? "Probe touches" : "Probe free");
}

}  // namespace grinder
