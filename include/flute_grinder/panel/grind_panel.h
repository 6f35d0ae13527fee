#pragma once

#include "flute_grinder/connection/master_watch.h"
#include "flute_grinder/panel/grinder_link.h"
#include "flute_grinder/panel/job_box.h"
#include "flute_grinder/panel/override_box.h"
#include "flute_grinder/panel/readout.h"

#include <rviz/panel.h>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTimer>

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace flute_grinder {

/// The operator's panel in rviz: chooses, plans and runs a job, and shows what the grinder does. A button is enabled
/// where the table of the machine's states allows what it asks for, and the stops alone where the grinder says
/// nothing; Start wants a job that was planned without a violation besides. Without a ROS master the stops alone are
/// left. Nothing here waits for the grinder or the master, and both are found again when they come back.
///
/// Its configuration: `Node`, the name of the grinder's node, relative to rviz's namespace; `Job`, the job file.
class GrindPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit GrindPanel(QWidget* parent = nullptr);

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  /// A goal that was sent from here and has not ended.
  struct Sent {
    std::string id;
    GrindGoal goal;
  };

  void layOut();
  QPushButton* addButton(const EventRow& request, bool large);
  void setNode(const QString& node);
  void refresh();
  void connectLink();
  bool allowed(MachineEvent event, const GrinderView& view) const;
  void ask(MachineEvent event);
  void plan(const GrindGoal& goal);
  void dryRun(const GrindGoal& goal);
  void send(const GrindGoal& goal);
  void onResult(const std::string& id, const GrindResult& result);
  void setFeedOverride(double fraction);
  void say(const std::string& text);

  const std::shared_ptr<MasterWatch> master_watch_;
  QString node_;                       ///< as it was given
  std::string name_;                   ///< resolved; empty where it is none
  std::unique_ptr<GrinderLink> link_;  ///< null where the name is none, or no master has answered since it was given
  bool planning_ = false;
  std::optional<Sent> sent_;

  StateBox* state_;
  JobBox* job_;
  std::map<MachineEvent, QPushButton*> buttons_;
  OverrideBox* override_;
  ProgressBox* progress_;
  PositionBox* position_;
  QPlainTextEdit* messages_;
  QLineEdit* node_edit_;
  QTimer refresh_timer_;
};

}  // namespace flute_grinder
