#pragma once

#include "flute_grinder/client/grinder_client.h"
#include "flute_grinder/network/master_watch.h"
#include "panel/correction_dialog.h"
#include "panel/hold_key.h"
#include "panel/job_box.h"
#include "panel/jog_box.h"
#include "panel/lamp_box.h"
#include "panel/legend_box.h"
#include "panel/node_dialog.h"
#include "panel/override_box.h"
#include "panel/readout.h"
#include "panel/rviz_view.h"
#include "panel/rviz_window.h"
#include "panel/section_view.h"
#include "panel/touch_off_box.h"

#include <rviz/panel.h>
#include <QCheckBox>
#include <QPlainTextEdit>
#include <QPointer>
#include <QPushButton>
#include <QTabWidget>
#include <QTimer>

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// The operator's panel in rviz: chooses, plans and runs a job, and shows what the grinder does. A button is enabled
/// if the state table allows its request and it would change something; Hold wherever it is allowed, and Start only
/// with a plan without violations. Space is Hold; no key starts, cancels or disables. No window is ever modal. Without
/// messages from the grinder, or without a ROS master, only the stops are enabled. Nothing here waits for the grinder
/// or the master, and both are found again when they come back. While the grinder moves, the panel stays
/// on the screen and shows no other grinder.
///
/// Configuration: `Node`, the name of the grinder's node, relative to rviz's namespace; `Job`, the job file.
class GrindPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit GrindPanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  /// A goal sent by this panel that has not ended.
  struct Sent {
    std::string id;
    flute_grinder::GrindGoal goal;
  };

  /// A touch-off from this panel, with the previous work offset.
  struct Touched {
    int axis;
    WorkOffset before;
  };

  /// The state to which a request leads.
  struct Passing {
    MachineState state;
    bool seen;
    QString reply;  ///< reply to the request, valid in this state; empty until it has come
  };

  void layOut();
  QLayout* layOutButtons();
  QLayout* layOutSwitches();
  QWidget* viewTab();
  QPushButton* addButton(const EventRow& request, bool large);
  void setNode(const QString& node);
  void refresh();
  QString whatMoves(const GrinderView& view) const;
  void keepWhileItMoves(const GrinderView& view);
  void connectLink();
  void nameWindows();
  void showLegend(const std::optional<flute_grinder::Legend>& legend);
  bool allowed(MachineEvent event, const GrinderView& view) const;
  void request(MachineEvent event);
  void dropPassedReply(std::optional<MachineState> state);
  void plan(const flute_grinder::GrindGoal& goal);
  void send(const flute_grinder::GrindGoal& goal);
  void onResult(const flute_grinder::GrindActionResult& ended);
  void setFeedOverride(double fraction);
  void jogStep(int axis, double distance, double speed);
  void askToTouchOff(int axis, double at);
  void touchOff(const Touched& what, double position, const OffsetBasis& basis,
                const std::vector<std::string>& answers = {});
  void offerBack(const std::optional<Touched>& touched);
  void askToTakeBack();
  void askReclamped();
  void openCorrection();
  OffsetBasis touchedFor(int axis) const;
  /// The work Y at which the chosen job's wheel touches a blank [m]. @throw std::exception with the reason if it
  /// cannot.
  double touchedY(double diameter) const;
  void showOtherJob(const GrinderView& view, bool job_runs);
  /// Shows a reply instead of the previous one. @param text the reply; its first line is in sight.
  void showMessage(const std::string& text);
  /// Shows the answer to a request. @param done text if the request succeeds.
  GrinderClient::OnAnswer reply(const std::string& done);

  const std::shared_ptr<MasterWatch> master_watch_;
  const std::shared_ptr<HoldKey> hold_key_;
  QString node_;                         ///< name of the node, as entered
  std::string name_;                     ///< resolved name of the node; empty if invalid
  QString titled_;                       ///< name that this panel has put into the window's title
  std::unique_ptr<GrinderClient> link_;  ///< null if the name is invalid, or until a master answers
  std::optional<Sent> sent_;
  std::optional<Passing> passing_;  ///< state to which the last request leads
  std::optional<Touched> touched_;  ///< touch-off that can be taken back
  std::string last_sent_;           ///< id of the last goal sent by this panel
  bool begun_ = false;              ///< a job of any client is running or was sent

  StateBox* state_;
  LampBox* lamps_;
  JobBox* job_;
  SectionView* section_;
  JogBox* jog_;
  TouchOffBox* touch_off_;
  LegendBox* legend_;
  QPushButton* look_;  ///< looks at the tool
  QCheckBox* cut_open_;
  QTabWidget* tabs_;          ///< tabs of job, section, jog, zero points and view
  RvizView* rviz_ = nullptr;  ///< null without rviz
  std::optional<flute_grinder::Cutter> looked_at_;
  std::map<MachineEvent, QPushButton*> buttons_;
  OverrideBox* override_;
  ProgressBox* progress_;
  PositionBox* position_;
  QPlainTextEdit* messages_;
  QPushButton* choose_node_;
  NodeDialog* node_dialog_;
  QPointer<CorrectionDialog> correction_;
  RvizWindow* rviz_window_;            ///< window around this panel
  QString moves_;                      ///< text on what moves, as last known; empty if nothing does
  std::atomic<bool> has_news_{false};  ///< refresh() has been called for, and has not begun
  QTimer refresh_timer_;               ///< runs out when no news come
};

}  // namespace grinder
