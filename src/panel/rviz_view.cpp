#include "panel/rviz_view.h"

#include "flute_grinder/scene/markers.h"

#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <QEvent>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

constexpr std::chrono::seconds kUntilAtRest{1};
constexpr int kPause = 67;       ///< pause; with rviz's own interval of 33 ms a frame takes 100 ms [ms]
constexpr double kDistance = 4;  ///< distance of the camera, as a multiple of the flutes' length or diameter
constexpr const char* kFrame = "work";
constexpr const char* kMarkers = "rviz/MarkerArray";  ///< class of displays

/// Whether an event of the mouse turns or shifts the view.
bool isMotion(QEvent::Type type) {
  return type == QEvent::MouseMove || type == QEvent::MouseButtonPress || type == QEvent::Wheel;
}

/// The property of this name below another; null if there is none.
rviz::Property* childOf(const rviz::Property* property, const QString& name) {
  for (int i = 0; property != nullptr && i < property->numChildren(); ++i) {
    if (property->childAt(i)->getName() == name) return property->childAt(i);
  }
  return nullptr;
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

std::vector<rviz::Display*> RvizView::markers() const {
  std::vector<rviz::Display*> found;
  const rviz::DisplayGroup& all = *manager_.getRootDisplayGroup();
  for (int i = 0; i < all.numDisplays(); ++i) {
    if (all.getDisplayAt(i)->getClassId() == kMarkers) found.push_back(all.getDisplayAt(i));
  }
  return found;
}

rviz::Property* RvizView::cutOut() const {
  for (const rviz::Display* display : markers()) {
    if (auto* found = childOf(childOf(display, "Namespaces"), kCutOut)) return found;
  }
  return nullptr;
}

std::optional<bool> RvizView::isCutOpen() const {
  const rviz::Property* shown = cutOut();
  return shown != nullptr ? std::optional(!shown->getValue().toBool()) : std::nullopt;
}

void RvizView::setCutOpen(bool open) {
  if (auto* shown = cutOut()) shown->setValue(!open);
  // rviz has thrown away what it hid.
  if (!open) askForMarkers();
  resume();
}

/// A topic that keeps its last message sends it to whoever subscribes.
void RvizView::askForMarkers() {
  for (rviz::Display* display : markers()) {
    if (!display->isEnabled()) continue;
    display->setEnabled(false);
    display->setEnabled(true);
  }
}

/// Called when rviz draws a frame, which its timer repeats; at rest the timer pauses.
void RvizView::beginFrame() {
  const double elapsed = manager_.getWallClockElapsed();
  if (elapsed < std::exchange(last_elapsed_, elapsed)) askForMarkers();
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
