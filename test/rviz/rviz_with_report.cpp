/// @file
/// rviz as it is, and services beside it: `~report` reports how many frames it has drawn, where its window and the
/// screen are, how small the window can be, its title, where its view looks, which dialogs and buttons are seen, and
/// what its displays say of themselves; `~look` turns the view as the parameter `~camera` says, and `~operate` does
/// what the hand does by `~operation`.

#include <ros/ros.h>
#include <rviz/display_group.h>
#include <rviz/panel_dock_widget.h>
#include <rviz/properties/status_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <rviz/visualizer_app.h>
#include <std_srvs/Trigger.h>
#include <QAbstractButton>
#include <QAction>
#include <QApplication>
#include <QDialog>
#include <QMenuBar>
#include <QScreen>
#include <QTabBar>
#include <QTimer>
#include <QToolButton>
#include <QtTest>

#include <algorithm>
#include <sstream>

namespace {

rviz::VisualizationFrame* window() {
  for (QWidget* widget : QApplication::topLevelWidgets()) {
    if (auto* frame = dynamic_cast<rviz::VisualizationFrame*>(widget)) return frame;
  }
  return nullptr;
}

void writeRectangle(const char* name, const QRect& r, std::ostream& text) {
  text << name << " " << r.x() << " " << r.y() << " " << r.width() << " " << r.height() << "\n";
}

/// A line "camera yaw pitch distance x y z frame" of a view that orbits [rad, m].
void writeCamera(rviz::ViewController& view, std::ostream& text) {
  rviz::Property& focus = *view.subProp("Focal Point");
  text << "camera";
  for (rviz::Property* value :
       {view.subProp("Yaw"), view.subProp("Pitch"), view.subProp("Distance"), focus.subProp("X"), focus.subProp("Y"),
        focus.subProp("Z"), view.subProp("Target Frame")}) {
    text << " " << value->getValue().toString().toStdString();
  }
  text << "\n";
}

/// A line "status level path: text" for each status at or below a property: level 0 is OK, 1 a warning, 2 an error.
void writeStatus(rviz::Property& property, const std::string& path, std::ostream& text) {
  const std::string name = path + "/" + property.getName().toStdString();
  if (auto* status = dynamic_cast<rviz::StatusProperty*>(&property)) {
    std::string value = status->getValue().toString().toStdString();
    std::replace(value.begin(), value.end(), '\n', ' ');
    text << "status " << status->getLevel() << " " << name << ": " << value << "\n";
  }
  for (int i = 0; i < property.numChildren(); ++i) writeStatus(*property.childAt(i), name, text);
}

/// A line "dialog name" for each dialog that is seen, and a line "button name enabled x y width height" for each
/// button, and for the panel's replies, of which all is seen.
void writeWhatIsSeen(std::ostream& text) {
  for (const QWidget* widget : QApplication::allWidgets()) {
    if (!widget->isVisible() || widget->objectName().isEmpty()) continue;
    const std::string name = widget->objectName().toStdString();
    if (qobject_cast<const QDialog*>(widget)) text << "dialog " << name << "\n";
    const bool counts = qobject_cast<const QAbstractButton*>(widget) || name == "messages";
    if (!counts || widget->visibleRegion().boundingRect() != widget->rect()) continue;
    writeRectangle(("button " + name + (widget->isEnabled() ? " 1" : " 0")).c_str(),
                   QRect(widget->mapToGlobal(QPoint(0, 0)), widget->size()), text);
  }
}

/// A button by its name, rviz's view, or what rviz gives no name: its reset, the panel's close box, and the arrow that
/// folds it.
QWidget* widgetNamed(const QString& name) {
  if (name == "view") return window()->getManager()->getRenderPanel();
  for (auto* button : window()->findChildren<QToolButton*>()) {
    if (name == "reset_of_rviz" && button->text() == "Reset") return button;
  }
  if (name == "fold") return window()->centralWidget()->findChildren<QToolButton*>().last();
  for (auto* dock : window()->findChildren<rviz::PanelDockWidget*>()) {
    if (name == "close_box" && dock->windowTitle().startsWith("Grinder")) {
      return dock->titleBarWidget()->findChild<QToolButton*>();
    }
  }
  return window()->findChild<QAbstractButton*>(name);
}

/// "key Ctrl+Q", "click hold", "tab Jog" or "menu &Quit".
void doByHand(const QString& operation) {
  const QString what = operation.section(' ', 0, 0), which = operation.section(' ', 1);
  if (what == "key") {
    const int key = QKeySequence(which)[0];
    // Without a window manager none is active by itself, and shortcuts work in the active one.
    if (!QGuiApplication::focusWindow()) window()->activateWindow();
    if (!QTest::qWaitFor([] { return QGuiApplication::focusWindow() != nullptr; })) return;
    QTest::keyClick(QGuiApplication::focusWindow(), static_cast<Qt::Key>(key & ~Qt::KeyboardModifierMask),
                    Qt::KeyboardModifiers(key & Qt::KeyboardModifierMask));
  } else if (what == "click") {
    QTest::mouseClick(widgetNamed(which), Qt::LeftButton);
  } else if (what == "menu") {
    // A menu that is off does not open. trigger() asks for neither.
    for (auto* menu : window()->menuBar()->findChildren<QMenu*>()) {
      for (auto* action : menu->menuAction()->isEnabled() ? menu->actions() : QList<QAction*>()) {
        if (action->text() == which && action->isEnabled()) action->trigger();
      }
    }
  } else {
    for (auto* bar : window()->findChildren<QTabBar*>()) {
      for (int i = 0; i < bar->count(); ++i) {
        if (bar->tabText(i) == which) QTest::mouseClick(bar, Qt::LeftButton, {}, bar->tabRect(i).center());
      }
    }
  }
}

/// Answers first: what is done may open a window, or end rviz.
bool operate(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  std::string operation;
  response.success = static_cast<std::uint8_t>(window() != nullptr && ros::param::get("~operation", operation));
  if (response.success) QTimer::singleShot(0, window(), [=] { doByHand(QString::fromStdString(operation)); });
  return true;
}

/// Called in the thread of the windows, where rviz takes its messages.
bool report(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  rviz::VisualizationFrame* frame = window();
  response.success = frame != nullptr;
  if (frame == nullptr) return true;
  rviz::VisualizationManager& manager = *frame->getManager();
  const QWidget& view = *manager.getRenderPanel();
  std::ostringstream text;
  text << "frames " << manager.getFrameCount() << "\n";
  writeRectangle("screen", QGuiApplication::primaryScreen()->geometry(), text);
  writeRectangle("window", frame->frameGeometry(), text);
  writeRectangle("least", QRect(QPoint(0, 0), frame->minimumSizeHint()), text);
  text << "title " << frame->windowTitle().toStdString() << "\n";
  for (const rviz::PanelDockWidget* dock : frame->findChildren<rviz::PanelDockWidget*>()) {
    text << "dock " << dock->windowTitle().toStdString() << "\n";
  }
  writeCamera(*manager.getViewManager()->getCurrent(), text);
  writeRectangle("view", QRect(view.mapToGlobal(QPoint(0, 0)), view.size()), text);
  writeStatus(*manager.getRootDisplayGroup(), "", text);
  writeWhatIsSeen(text);
  response.message = text.str();
  return true;
}

/// Turns the view to frame, yaw, pitch, distance, x, y, z.
bool look(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  XmlRpc::XmlRpcValue camera;
  if (window() == nullptr || !ros::param::get("~camera", camera)) return false;
  rviz::ViewController& view = *window()->getManager()->getViewManager()->getCurrent();
  rviz::Property& focus = *view.subProp("Focal Point");
  view.subProp("Target Frame")->setValue(QString::fromStdString(static_cast<std::string>(camera[0])));
  int i = 0;
  for (rviz::Property* value : {view.subProp("Yaw"), view.subProp("Pitch"), view.subProp("Distance"),
                                focus.subProp("X"), focus.subProp("Y"), focus.subProp("Z")}) {
    value->setValue(static_cast<double>(camera[++i]));
  }
  response.success = 1;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  QApplication application(argc, argv);
  rviz::VisualizerApp rviz;
  rviz.setApp(&application);
  if (!rviz.init(argc, argv)) return 1;
  ros::NodeHandle private_nh("~");
  const ros::ServiceServer service = private_nh.advertiseService("report", &report);
  const ros::ServiceServer look_service = private_nh.advertiseService("look", &look);
  const ros::ServiceServer operate_service = private_nh.advertiseService("operate", &operate);
  return QApplication::exec();
}
