#include "panel/grind_panel.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/setup/touch_off.h"
#include "panel/beside.h"
#include "panel/click_guard.h"
#include "panel/panel_button.h"
#include "panel/plain_words.h"
#include "panel/text_view.h"
#include "panel/wheel_guard.h"

#include <rviz/panel_dock_widget.h>
#include <QFileInfo>
#include <QGridLayout>
#include <QScrollArea>
#include <QTime>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <set>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr int kRefreshInterval = 100;  ///< time without news from the grinder until it is looked at all the same [ms]
constexpr const char* kTitleSeparator = " - ";  ///< separator as in rviz's own title
constexpr int kButtonColumns = 4;
constexpr int kSpacing = 3;            ///< gap between the panel's parts, which must fit a screen of 1024 x 768 [px]
constexpr int kLowestTab = 120;        ///< height of the part of a tab that is always in sight [px]
constexpr int kApart = 14;             ///< gap between the last column of buttons and the others [px]
constexpr double kLargerGauge = 1e-3;  ///< excess over blank and shank at which a gauge for Y is plausible [m]
constexpr int kDiameterDigits = 5;
constexpr int kOffsetDigits = 7;

QString capitalized(const std::string& text) {
  QString words = QString::fromStdString(text);
  if (!words.isEmpty()) words[0] = words[0].toUpper();
  return words;
}

/// Whether a state already has, or is about to have, the result of a request.
bool isDone(MachineState state, MachineEvent event) {
  switch (event) {
    case MachineEvent::kEnable: return state == MachineState::kReady;
    case MachineEvent::kDisable: return !isPowered(state);
    case MachineEvent::kCancel: return state == MachineState::kCanceling;
    default: return false;
  }
}

/// Whether two cutters have the same size in a view.
bool isSameSize(const flute_grinder::Cutter& a, const flute_grinder::Cutter& b) {
  return a.end_diameter == b.end_diameter && a.cone_angle == b.cone_angle && a.flute_length == b.flute_length;
}

/// Makes the page of a tab scroll on a low screen, so that the rest of the panel stays in sight.
QScrollArea* scrolling(QWidget* page) {
  auto* area = new QScrollArea;
  area->setWidget(page);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setMinimumHeight(kLowestTab);
  return area;
}

/// Why a diameter is implausible for touching off Y for a job; empty if it is plausible.
std::string diameterDoubt(const GrindJob& job, double diameter) {
  const CutterGeometry& cutter = job.cutter;
  const double blank = std::max(cutter.end_diameter, 2 * ConicalCutter(cutter).radius(cutter.flute_length));
  if (diameter <= std::max(blank, cutter.shank_diameter) + kLargerGauge) return "";
  const auto shown = [](double d) { return "D " + text(Quantity{d, Unit::kMetre}, kDiameterDigits); };
  return shown(diameter) + " was entered. The largest blank of this job has " + shown(blank) + ", its shank " +
         shown(cutter.shank_diameter) + ".";
}

/// A comparison of a work offset before and after a change.
Comparison change(int axis, const WorkOffset& before, double after) {
  const auto shown = [axis](double value) {
    return QString::fromStdString(text(Quantity{value, unitOf(axis, 0)}, kOffsetDigits));
  };
  const bool known = before.wasSet() && std::isfinite(before.value);
  const QString was = known ? shown(before.value) : "never set", by = known ? shown(after - before.value) : "";
  return {{"now", "then", "change"}, {{QString("%1").arg(axisLetter(axis)), was, shown(after), by}}};
}

/// The object shared by all panels of the process.
template <typename Shared>
std::shared_ptr<Shared> theOnly() {
  static std::weak_ptr<Shared> the;
  auto shared = the.lock();
  if (!shared) the = shared = std::make_shared<Shared>();
  return shared;
}

}  // namespace

GrindPanel::GrindPanel(QWidget* parent)
    : rviz::Panel(parent),
      master_watch_(theOnly<MasterWatch>()),
      hold_key_(theOnly<HoldKey>()),
      state_(new StateBox),
      lamps_(new LampBox),
      job_(new JobBox),
      section_(new SectionView),
      jog_(new JogBox),
      touch_off_(new TouchOffBox),
      legend_(new LegendBox),
      look_(new PanelButton("look_at_tool", "Look at the tool",
                            "Turn rviz's view back to the tool; it does so by itself when another tool is shown")),
      cut_open_(new QCheckBox("Cut open")),
      tabs_(new QTabWidget),
      override_(new OverrideBox),
      progress_(new ProgressBox),
      position_(new PositionBox),
      messages_(textView("messages", 2)),
      choose_node_(new PanelButton("choose_node", "Grinder...", "Choose which grinder this panel shows")),
      node_dialog_(new NodeDialog(*this)),
      rviz_window_(new RvizWindow(*this)) {
  messages_->setPlaceholderText("Replies from the grinder");
  layOut();
  guardFromWheel(*this);
  // The stops take every click.
  std::set<QWidget*> stops;
  for (const auto& [event, button] : buttons_) {
    if (isStop(event)) stops.insert(button);
  }
  guardFromDoubleClicks(*this, stops);
  hold_key_->add(*buttons_.at(MachineEvent::kHold));
  connect(job_, &JobBox::planWanted, this, &GrindPanel::plan);
  connect(job_, &JobBox::startWanted, this, &GrindPanel::send);
  connect(job_, &JobBox::startDelayed, this, [this] { tabs_->setCurrentIndex(0); });
  connect(job_, &JobBox::fileChosen, this, &GrindPanel::configChanged);
  connect(override_, &OverrideBox::wanted, this, &GrindPanel::setFeedOverride);
  connect(jog_, &JogBox::stepWanted, this, &GrindPanel::jogStep);
  connect(jog_, &JogBox::continuousWanted, this, [this](int axis, double velocity) {
    if (link_) link_->jog(axis, velocity);
  });
  connect(touch_off_, &TouchOffBox::wanted, this, &GrindPanel::askToTouchOff);
  connect(touch_off_, &TouchOffBox::backWanted, this, &GrindPanel::askToTakeBack);
  connect(touch_off_, &TouchOffBox::reclampedWanted, this, &GrindPanel::askReclamped);
  connect(touch_off_, &TouchOffBox::measuredWanted, this, &GrindPanel::openCorrection);
  connect(look_, &QPushButton::clicked, this, [this] { rviz_->lookAt(*looked_at_); });
  cut_open_->setObjectName("cut_open");
  cut_open_->setToolTip("Leave out a wedge of the ground cutter in rviz, to see its section along the axis");
  connect(cut_open_, &QCheckBox::clicked, this, [this](bool open) { rviz_->setCutOpen(open); });
  connect(choose_node_, &QPushButton::clicked, this, [this] { node_dialog_->ask(node_); });
  connect(node_dialog_, &NodeDialog::chosen, this, [this](const QString& node) {
    if (node == node_) return;
    setNode(node);
    Q_EMIT configChanged();
  });
  connect(&refresh_timer_, &QTimer::timeout, this, &GrindPanel::refresh);
  setNode("grinder");
}

void GrindPanel::layOut() {
  auto* by_hand = new QWidget;
  by_hand->setAutoFillBackground(true);
  auto* hand_layout = new QVBoxLayout(by_hand);
  hand_layout->setContentsMargins(6, 4, 6, 2);
  hand_layout->setSpacing(2);
  hand_layout->addWidget(jog_);
  hand_layout->addLayout(layOutSwitches());
  hand_layout->addStretch(1);
  tabs_->setObjectName("tabs");
  // The page of the jog buttons does not scroll, so that a button never moves to the place of the opposite one.
  for (const auto& [page, title] :
       std::initializer_list<std::pair<QWidget*, const char*>>{{scrolling(job_), "Job"},
                                                               {scrolling(section_), "Section"},
                                                               {by_hand, "Jog"},
                                                               {scrolling(touch_off_), "Zero"},
                                                               {scrolling(viewTab()), "View"}}) {
    tabs_->addTab(page, title);
  }
  messages_->setFixedHeight(messages_->minimumHeight());

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(9, 4, 9, 4);
  layout->setSpacing(kSpacing);
  layout->addWidget(state_);
  layout->addWidget(lamps_);
  // The stops stay in place whatever is below them.
  layout->addLayout(layOutButtons());
  layout->addWidget(messages_);
  layout->addWidget(override_);
  layout->addWidget(progress_);
  layout->addWidget(position_);
  layout->addWidget(tabs_, 1);
}

QLayout* GrindPanel::layOutButtons() {
  auto* buttons = new QGridLayout;
  buttons->setVerticalSpacing(kSpacing);
  buttons->setColumnMinimumWidth(kButtonColumns - 1, kApart);
  int place = 0;
  const auto add = [&](const EventRow& request) {
    // Large buttons for a hand in a hurry.
    const bool large = request.value == MachineEvent::kStart || request.value == MachineEvent::kHold;
    const int first = place % kButtonColumns, last = first + (large ? 1 : 0);
    // One column of the grid is the gap.
    const auto column = [](int of) { return of < kButtonColumns - 1 ? of : of + 1; };
    buttons->addWidget(addButton(request, large), place / kButtonColumns, column(first), 1,
                       column(last) - column(first) + 1);
    place += last - first + 1;
  };
  for (const EventRow& request : kMachineEvents) {
    const bool offered = isRequest(request.value) && !isSwitch(request.value) && request.value != MachineEvent::kJog;
    if (offered && request.value != MachineEvent::kCancel) add(request);
  }
  // Cancel comes last, so that it is not hit instead of Resume.
  add(rowOf(MachineEvent::kCancel));
  for (const int column : {0, 1, 2, kButtonColumns}) buttons->setColumnStretch(column, 1);
  return buttons;
}

QLayout* GrindPanel::layOutSwitches() {
  auto* switches = new QHBoxLayout;
  switches->setSpacing(kSpacing);
  QString part;
  for (const EventRow& request : kMachineEvents) {
    if (!isSwitch(request.value)) continue;
    // For "spindle on", the first word stands before its two buttons.
    const QStringList words = QString(request.name).split(' ');
    if (words[0] != part) switches->addWidget(new QLabel(capitalized(words[0].toStdString())));
    part = words[0];
    QPushButton* button = addButton(request, false);
    button->setText(capitalized(words[1].toStdString()));
    switches->addWidget(button, 1);
  }
  return switches;
}

QWidget* GrindPanel::viewTab() {
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(look_);
  buttons->addWidget(cut_open_);
  buttons->addStretch(1);
  buttons->addWidget(choose_node_);
  auto* tab = new QWidget;
  auto* layout = new QVBoxLayout(tab);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addWidget(legend_);
  layout->addStretch(1);
  layout->addLayout(buttons);
  return tab;
}

QPushButton* GrindPanel::addButton(const EventRow& request, bool large) {
  auto* button =
      new PanelButton(QString(request.name).replace(' ', '_'), capitalized(request.name), capitalized(request.help));
  button->setEnabled(false);
  if (large) {
    QFont bold = font();
    bold.setBold(true);
    button->setFont(bold);
    button->setMinimumHeight(2 * fontMetrics().height() + 2);
  }
  const MachineEvent event = request.value;
  buttons_[event] = button;
  connect(button, &QPushButton::clicked, this, [this, event] { this->request(event); });
  return button;
}

void GrindPanel::onInitialize() { rviz_ = new RvizView(*vis_manager_, this); }

void GrindPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString node, job;
  if (config.mapGetString("Node", &node)) setNode(node);
  if (config.mapGetString("Job", &job)) job_->setFile(job);
}

void GrindPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Node", node_);
  config.mapSetValue("Job", job_->file());
}

void GrindPanel::setNode(const QString& node) {
  node_ = node;
  moves_.clear();
  sent_.reset();
  job_->discardPlan();  // the plan is for another machine
  offerBack(std::nullopt);
  if (correction_) correction_->close();
  override_->reset();
  link_.reset();
  name_.clear();
  try {
    if (node.isEmpty()) throw ros::InvalidNameException("the name is empty");
    name_ = ros::names::resolve(node.toStdString());
    job_->setGrinder(name_);
  } catch (const ros::InvalidNameException& error) {
    showMessage(std::string("grinder's node: ") + error.what());
  }
  refresh();
}

void GrindPanel::connectLink() {
  // Without a master the link would wait for one.
  if (name_.empty() || master_watch_->master() == Master::kMissing) return;
  link_ = std::make_unique<GrinderClient>(
      name_, [this](const flute_grinder::GrindActionResult& ended) { onResult(ended); },
      [this](const std::string& refusal) { showMessage(refusal); },
      [this] {
        // One look for all that comes until then.
        if (!has_news_.exchange(true))
          QMetaObject::invokeMethod(
              this, [this] { refresh(); }, Qt::QueuedConnection);
      });
}

void GrindPanel::refresh() {
  has_news_ = false;
  refresh_timer_.start(kRefreshInterval);
  GrinderView view;
  if (!link_) connectLink();
  if (link_) {
    link_->deliver();
    view = link_->view();
  }
  const Master master = master_watch_->master();
  std::optional<MachineState> state;
  if (view.state) state = static_cast<MachineState>(view.state->state);
  if (!state && sent_) {  // no result comes from a grinder that is gone
    sent_.reset();
    job_->discardPlan();
  }
  dropPassedReply(state);
  keepWhileItMoves(view);
  nameWindows();
  state_->show(view, name_.empty() ? node_ : QString::fromStdString(name_), master);
  const bool job_runs = state && isInJob(*state);
  const bool idle = state && !job_runs && !sent_ && !view.planned;
  showOtherJob(view, job_runs);
  const bool begun = job_runs || (state && sent_ && !sent_->goal.dry_run);
  if (begun && !begun_ && view.state->override != 1) {
    showMessage(format("the job begins at a feed override of %.0f %%", view.state->override * 100));
  }
  begun_ = begun;
  for (const auto& [event, button] : buttons_) button->setEnabled(allowed(event, view));
  lamps_->show(view);
  job_->refresh(view.state, view.offsets, idle && master == Master::kAnswers);
  jog_->refresh(view.state, view.machine ? view.machine->jog_timeout : 0, master == Master::kAnswers);
  touch_off_->refresh(view, master == Master::kAnswers, job_->job() && !name_.empty());
  if (correction_) correction_->refresh(view.offsets, master == Master::kAnswers && TouchOffBox::maySet(view));
  override_->setEnabled(master == Master::kAnswers);
  override_->refresh(view.state);
  progress_->show(view, job_runs);
  position_->show(view);
  section_->refresh(view, job_->job());
  showLegend(view.legend);
  if (rviz_) rviz_->keepPace(state && rowOf(*state).moves);
}

/// Text on what moves or is about to move; empty if nothing does.
QString GrindPanel::whatMoves(const GrinderView& view) const {
  const auto state = static_cast<MachineState>(view.state->state);
  const QString name = QString::fromStdString(name_);
  if (isInJob(state)) {
    const QString job = view.job ? QString::fromStdString(describe(view.job->goal)) : "a job";
    return name + " grinds " + job + ".";
  }
  if (view.planned || sent_) return name + " is about to start a job.";
  if (rowOf(state).moves) return name + " moves an axis.";
  return view.state->spindle_commanded ? "The spindle of " + name + " is on." : QString();
}

void GrindPanel::keepWhileItMoves(const GrinderView& view) {
  // A grinder whose messages do not arrive may still be moving, as long as it can be stopped from here.
  if (view.state || !link_ || !link_->stopsConnected()) moves_ = view.state ? whatMoves(view) : QString();
  choose_node_->setEnabled(moves_.isEmpty());
  if (!moves_.isEmpty()) node_dialog_->hide();
  rviz_window_->keepPanel(moves_);
}

/// Puts the grinder's name into the titles, for the case of two grinders. To be repeated, because rviz sets the title
/// when it reads or writes a file.
void GrindPanel::nameWindows() {
  const QString name = QString::fromStdString(name_);
  if (auto* dock = qobject_cast<rviz::PanelDockWidget*>(parentWidget())) {
    const QString title = (getName() + " " + name).trimmed();
    if (dock->windowTitle() != title) dock->setWindowTitle(title);
  }
  QStringList parts = window()->windowTitle().split(kTitleSeparator);
  parts.removeAll(QString());
  if (titled_ == name && (name.isEmpty() || parts.contains(name))) return;
  if (titled_ != name) parts.removeAll(titled_);
  if (!name.isEmpty()) parts.prepend(name);
  window()->setWindowTitle(parts.join(kTitleSeparator));
  titled_ = name;
}

void GrindPanel::showLegend(const std::optional<flute_grinder::Legend>& legend) {
  legend_->show(legend);
  position_->setTolerance(legend ? std::optional<double>(legend->tolerance) : std::nullopt);
  look_->setEnabled(rviz_ && looked_at_);
  const std::optional<bool> open = rviz_ ? rviz_->isCutOpen() : std::nullopt;
  cut_open_->setEnabled(open.has_value());
  cut_open_->setChecked(open.value_or(false));
  if (!rviz_ || !legend) return;
  // Only for another tool, so that a view chosen by the operator stays.
  const bool other = !looked_at_ || !isSameSize(*looked_at_, legend->cutter);
  looked_at_ = legend->cutter;
  if (other) rviz_->lookAt(legend->cutter);
}

bool GrindPanel::allowed(MachineEvent event, const GrinderView& view) const {
  // A grinder whose messages do not arrive may still receive a stop.
  if (!view.state) return isStop(event) && link_ && link_->stopsConnected();
  const auto state = static_cast<MachineState>(view.state->state);
  // A goal in planning or in transit can be canceled, or held before its first move.
  const bool planned = view.planned || (sent_ && !isInJob(state));
  const bool for_a_goal = event == MachineEvent::kCancel || event == MachineEvent::kHold;
  if (!(planned && for_a_goal) && (!after(state, event) || isDone(state, event))) return false;
  if (isStop(event)) return true;
  if (master_watch_->master() == Master::kMissing) return false;
  const bool in_work = view.state->wheel_in_work != 0;
  switch (event) {
    case MachineEvent::kHome: return !in_work && view.machine && view.machine->homing;
    case MachineEvent::kStart: return !in_work && !view.planned && job_->planned();
    case MachineEvent::kLift: return in_work;
    case MachineEvent::kResume: return view.state->homed != 0;
    case MachineEvent::kSpindleOn:
      return !in_work && !view.state->spindle_commanded && view.machine && view.machine->spindle;
    case MachineEvent::kCoolantOn:
      return !in_work && !view.state->coolant_commanded && view.machine && view.machine->coolant;
    case MachineEvent::kSpindleOff: return view.state->spindle_commanded != 0;
    case MachineEvent::kCoolantOff: return view.state->coolant_commanded != 0;
    default: return true;
  }
}

void GrindPanel::request(MachineEvent event) {
  if (event == MachineEvent::kStart) return job_->start();
  if (isStop(event)) return link_->stop(event, reply(done(event)));
  const auto state = link_->view().state;
  const auto next = state ? after(static_cast<MachineState>(state->state), event) : std::nullopt;
  passing_.reset();
  if (next) passing_ = Passing{*next, false, ""};
  link_->request(event, [this, event](const std::string& refusal) {
    showMessage(refusal.empty() ? done(event) : refusal);
    if (passing_ && refusal.empty()) passing_->reply = messages_->toPlainText();
  });
}

/// Removes a reply that is valid in a state only, once that state is over.
void GrindPanel::dropPassedReply(std::optional<MachineState> state) {
  if (!passing_) return;
  const bool there = state == passing_->state;
  passing_->seen = passing_->seen || there;
  if (there || !passing_->seen || passing_->reply.isEmpty()) return;
  if (messages_->toPlainText() == passing_->reply) messages_->clear();
  passing_.reset();
}

void GrindPanel::plan(const flute_grinder::GrindGoal& goal) {
  flute_grinder::GrindGoal dry = goal;
  dry.dry_run = true;
  send(dry);
  if (!sent_) job_->discardPlan();
}

void GrindPanel::send(const flute_grinder::GrindGoal& goal) {
  const auto id = link_->send(goal);
  if (id) {
    sent_ = Sent{*id, goal};
    last_sent_ = *id;
  }
  if (id && goal.dry_run) return;
  showMessage(id ? "the job was sent" : "the job was not sent: no answer from the grinder " + name_);
}

void GrindPanel::onResult(const flute_grinder::GrindActionResult& ended) {
  const flute_grinder::GrindResult& result = ended.result;
  const bool good = result.error_code == flute_grinder::GrindResult::SUCCESSFUL;
  if (sent_ && ended.status.goal_id.id == sent_->id) {
    flute_grinder::GrindGoal goal = sent_->goal;
    sent_.reset();
    if (goal.dry_run) {
      goal.dry_run = false;
      return job_->setPlan(goal, result);
    }
    if (!good && !result.plan.needs.empty()) job_->ask(goal, result.plan.needs);
  }
  if (!good) return showMessage("the job has ended: " + result.error_string);
  // A dry run of another client has written no setpoints.
  showMessage(result.setpoints_written > 0 ? "the job is done" : result.error_string);
}

void GrindPanel::setFeedOverride(double fraction) {
  const GrinderClient::OnAnswer show = reply(format("feed override: %.0f %%", fraction * 100));
  link_->setFeedOverride(fraction, [this, show](const std::string& refusal) {
    override_->answered();
    show(refusal);
  });
}

void GrindPanel::jogStep(int axis, double distance, double speed) {
  const std::string way = text(Quantity{distance, unitOf(axis, 0)});
  link_->jogStep(jogRequest(axis, distance, speed), reply("jog: " + axisName(axis) + " by " + way));
}

void GrindPanel::askToTouchOff(int axis, double at) {
  try {
    const OffsetBasis basis = touchedFor(axis);
    const double position = axis == kY ? touchedY(at) : at;
    const GrinderView view = link_->view();
    if (!view.state) throw std::invalid_argument("no position comes from the grinder");
    if (!view.offsets) throw std::invalid_argument("no work offsets come from the grinder");
    const auto i = static_cast<std::size_t>(axis);
    const WorkOffset before = fromMessage(*view.offsets).axes[i];
    std::string text = axis == kY && job_->job() ? diameterDoubt(*job_->job(), at) + "\n" : "";
    if (basis.hasJob()) text += "For " + basis.job_name + ", wheel " + wheelText(basis) + ".";
    touch_off_->ask(QString::fromStdString(text).trimmed(), change(axis, before, view.state->position[i] - position),
                    [=] {
                      touchOff({axis, before}, position, basis);
                    });
  } catch (const std::exception& error) {
    showMessage(std::string("touch-off: ") + error.what());
  }
}

void GrindPanel::touchOff(const Touched& what, double position, const OffsetBasis& basis,
                          const std::vector<std::string>& answers) {
  const auto answered = reply("touch-off: the work offset of " + axisName(what.axis) + " is set");
  link_->touchOff(touchOffRequest(what.axis, position, basis, answers),
                  [=](const std::string& refusal, const std::vector<flute_grinder::Need>& needs) {
                    answered(refusal);
                    if (refusal.empty()) offerBack(what.before.wasSet() ? std::optional<Touched>(what) : std::nullopt);
                    if (needs.empty()) return;
                    touch_off_->ask(needs.front(),
                                    [=](const std::string& id) { touchOff(what, position, basis, {id}); });
                  });
}

void GrindPanel::offerBack(const std::optional<Touched>& touched) {
  touched_ = touched;
  touch_off_->offerBack(touched ? touched->axis : kAxisCount);
}

/// Asks to restore the offset from before the last touch-off, with its basis.
void GrindPanel::askToTakeBack() {
  const auto message = link_->view().offsets;
  if (!message || !touched_) return;
  const auto [axis, before] = *touched_;
  const WorkOffsets offsets = fromMessage(*message);
  const WorkOffset& now = offsets.axes[static_cast<std::size_t>(axis)];
  // An offset set now counts for the wheel mounted now.
  if (before.mounting != offsets.wheel.mounting) {
    offerBack(std::nullopt);
    return showMessage("touch-off: another wheel has been mounted since; touch off anew");
  }
  touch_off_->ask("Set it back?", change(axis, now, before.value), [this, axis = axis, before = before] {
    const auto answered = reply("touch-off: the work offset of " + axisName(axis) + " is what it was");
    const std::vector<std::string> shown{toString(NeedAnswer::kSetOffset)};
    link_->setOffsets(offsetsRequest({{axis, before.value}}, before.basis, shown), [=](const std::string& refusal) {
      answered(refusal);
      if (refusal.empty()) offerBack(std::nullopt);
    });
  });
}

void GrindPanel::askReclamped() {
  const auto offsets = link_->view().offsets;
  if (!offsets) return;
  const std::string tool = toolText(fromMessage(*offsets).tool);
  touch_off_->ask(
      "Was a tool clamped? Where its teeth are is then not known, and an unfinished job cannot be continued.",
      {{"now", "then"}, {{"tool", QString::fromStdString(tool), "a blank, or to be probed"}}},
      [this] { link_->sayReclamped(reply("reclamped: where the teeth are is not known")); });
}

void GrindPanel::openCorrection() {
  if (correction_ && correction_->isVisible()) {
    correction_->raise();
    return correction_->activateWindow();
  }
  const std::string operation = job_->operation();
  correction_ = new CorrectionDialog(job_->file(), operation, QFileInfo(job_->file()).fileName(), name_, this);
  connect(correction_, &CorrectionDialog::wanted, this, [this, dialog = correction_](const auto& request) {
    link_->setOffsets(request, [this, dialog](const std::string& refusal) {
      showMessage(refusal.empty() ? "correction: the work offsets of Y and Z are set" : refusal);
      if (dialog) dialog->showAnswer(refusal);
    });
  });
  moveBeside(*correction_, *this);
  correction_->show();
}

/// The basis of an offset: the chosen job, if there is one. @throw std::exception with the reason if it is unknown.
OffsetBasis GrindPanel::touchedFor(int axis) const {
  OffsetBasis basis;
  basis.method = OffsetMethod::kTouchOff;
  if (!job_->file().isEmpty())
    return basisOf(goalFromFile(job_->file().toStdString(), job_->operation()), basis.method);
  if (axis == kY) {
    throw std::invalid_argument("Y is 0 where the wheel touches the small end of a job's cutter; open the job first");
  }
  if (axis == kZ) throw std::invalid_argument("Z is 0 at the height of a job's set-up; open the job first");
  return basis;
}

double GrindPanel::touchedY(double diameter) const {
  const GrindJob job = readJobFile(job_->file().toStdString(), job_->operation());
  const auto state = link_->view().state;
  if (!state) throw std::invalid_argument("no position comes from the grinder");
  const std::string refused = heightRefusal(job, state->work_position[kZ]);
  if (!refused.empty()) throw std::invalid_argument(refused);
  return touchY(job, diameter);
}

void GrindPanel::showOtherJob(const GrinderView& view, bool job_runs) {
  const bool other = job_runs && view.job && view.job->goal_id.id != last_sent_;
  job_->showOtherJob(
      other ? QString::fromStdString("Running: " + describe(view.job->goal) + ". It was not started in this panel.")
            : QString());
}

GrinderClient::OnAnswer GrindPanel::reply(const std::string& done) {
  return [this, done](const std::string& refusal) { showMessage(refusal.empty() ? done : refusal); };
}

void GrindPanel::showMessage(const std::string& text) {
  messages_->setPlainText(QTime::currentTime().toString("HH:mm:ss ") + capitalized(text));
}

}  // namespace grinder

PLUGINLIB_EXPORT_CLASS(grinder::GrindPanel, rviz::Panel)
