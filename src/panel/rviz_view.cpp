#include "panel/rviz_view.h"

#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <QEvent>

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

constexpr std::chrono::seconds kUntilAtRest{1};
constexpr int kPause = 67;       ///< pause; with rviz's own interval of 33 ms a frame takes 100 ms [ms]
constexpr double kDistance = 4;  ///< distance of the camera, as a multiple of the flutes' length or diameter
constexpr const char* kFrame = "work";

/// Whether an event of the mouse turns or shifts the view.
bool isMotion(QEvent::Type type) {
  return type == QEvent::MouseMove || type == QEvent::MouseButtonPress || type == QEvent::Wheel;
}

}  // namespace

RvizView::RvizView(rviz::VisualizationManager& manager, QObject* parent) : QObject(parent), manager_(manager) {
  pause_.setSingleShot(true);
  connect(&pause_, &QTimer::timeout, this, [this] { manager_.startUpdate(); });
  connect(&manager, &rviz::VisualizationManager::preUpdate, this, &RvizView::beginFrame);
  manager.getRenderPanel()->installEventFilter(this);
}

void RvizView::lookAt(const flute_grinder::Cutter& cutter) {
  rviz::ViewController* view = manager_.getViewManager()->getCurrent();
  const bool orbits = view && view->getClassId() == "rviz/Orbit";
  if (!orbits || view->subProp("Target Frame")->getValue().toString() != kFrame) return;
  const double length = cutter.flute_length;
  const double diameter = cutter.end_diameter + 2 * length * std::max(0.0, std::tan(cutter.cone_angle));
  view->subProp("Distance")->setValue(kDistance * std::max(length, diameter));
  rviz::Property* focus = view->subProp("Focal Point");
  focus->subProp("X")->setValue(length / 2);
  focus->subProp("Y")->setValue(0.0);
  focus->subProp("Z")->setValue(0.0);
  resume();
}

RvizView::~RvizView() { resume(); }

void RvizView::keepPace(bool moves) {
  if (moves) resume();
}

bool RvizView::eventFilter(QObject* watched, QEvent* event) {
  if (isMotion(event->type())) resume();
  return QObject::eventFilter(watched, event);
}

/// Called when rviz draws a frame, which its timer repeats; at rest the timer pauses.
void RvizView::beginFrame() {
  if (Clock::now() - last_motion_ < kUntilAtRest) return;
  manager_.stopUpdate();
  pause_.start(kPause);
}

void RvizView::resume() {
  last_motion_ = Clock::now();
  if (!pause_.isActive()) return;
  pause_.stop();
  manager_.startUpdate();
}

}  // namespace grinder
