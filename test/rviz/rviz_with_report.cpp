/// @file
/// rviz as it is, and one service beside it: `~report` tells how many frames it has drawn and what its displays say of
/// themselves.

#include <QApplication>
#include <ros/ros.h>
#include <rviz/display_group.h>
#include <rviz/properties/status_property.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <rviz/visualizer_app.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <sstream>

namespace {

rviz::VisualizationManager* manager() {
  for (QWidget* widget : QApplication::topLevelWidgets()) {
    if (auto* frame = dynamic_cast<rviz::VisualizationFrame*>(widget)) return frame->getManager();
  }
  return nullptr;
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

/// Called in the thread of the windows, where rviz takes its messages.
bool report(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  rviz::VisualizationManager* shown = manager();
  response.success = shown != nullptr;
  if (shown == nullptr) return true;
  std::ostringstream text;
  text << "frames " << shown->getFrameCount() << "\n";
  writeStatus(*shown->getRootDisplayGroup(), "", text);
  response.message = text.str();
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
  return QApplication::exec();
}
