#include "flute_grinder/operator/grind_panel.h"

#include "flute_grinder/operator/plain_words.h"
#include "flute_grinder/operator/text_view.h"

#include <QGridLayout>
#include <QTime>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

namespace flute_grinder {

namespace {

constexpr int kRefreshInterval = 50;  ///< as often as the grinder tells its state [ms]
constexpr int kMessages = 200;        ///< that are kept

bool jobRuns(const std::optional<MachineState>& state) { return state && after(*state, MachineEvent::kCancel); }

}  // namespace

GrindPanel::GrindPanel(QWidget* parent)
    : rviz::Panel(parent),
      state_(new StateBox),
      job_(new JobBox),
      override_(new OverrideBox),
      progress_(new ProgressBox),
      position_(new PositionBox),
      messages_(textView("messages", 3)),
      node_edit_(new QLineEdit) {
  messages_->setMaximumBlockCount(kMessages);
  messages_->setPlaceholderText("What the grinder has answered");
  node_edit_->setObjectName("node");
  node_edit_->setToolTip("Name of the grinder's node; relative to rviz's namespace without a slash in front");
  layOut();
  connect(job_, &JobBox::planWanted, this, &GrindPanel::plan);
  connect(job_, &JobBox::dryRunWanted, this, &GrindPanel::dryRun);
  connect(job_, &JobBox::fileChosen, this, &GrindPanel::configChanged);
  connect(override_, &OverrideBox::wanted, this, &GrindPanel::setFeedOverride);
  connect(node_edit_, &QLineEdit::editingFinished, this, [this] {
    if (node_edit_->text() == node_) return;
    setNode(node_edit_->text());
    Q_EMIT configChanged();
  });
  connect(&refresh_timer_, &QTimer::timeout, this, &GrindPanel::refresh);
  setNode("grinder");
  refresh_timer_.start(kRefreshInterval);
}

void GrindPanel::layOut() {
  auto* buttons = new QGridLayout;
  addButton(*buttons, 0, 0, 3, MachineEvent::kEnable, "Enable", "Switch the drive's power on; nothing moves");
  addButton(*buttons, 0, 3, 3, MachineEvent::kDisable, "Disable", "Switch the drive's power off");
  addButton(*buttons, 0, 6, 3, MachineEvent::kHome, "Home", "The drive finds the axes' reference; the axes may move");
  addButton(*buttons, 0, 9, 3, MachineEvent::kReset, "Reset", "Take a fault back; the power stays off");
  addButton(*buttons, 1, 0, 6, MachineEvent::kStart, "Start", "Grind the planned job");
  addButton(*buttons, 1, 6, 6, MachineEvent::kHold, "Hold", "Stop on the path; the wheel turns on");
  addButton(*buttons, 2, 0, 4, MachineEvent::kRetract, "Retract", "Lift the held wheel off the work");
  addButton(*buttons, 2, 4, 4, MachineEvent::kResume, "Resume", "Go on where the job was held");
  addButton(*buttons, 2, 8, 4, MachineEvent::kCancel, "Cancel", "Stop on the path and end the job");
  for (const MachineEvent event : {MachineEvent::kStart, MachineEvent::kHold}) {
    QFont bold = font();
    bold.setBold(true);
    buttons_[event]->setFont(bold);
    buttons_[event]->setMinimumHeight(2 * fontMetrics().height() + 6);
  }

  auto* node = new QHBoxLayout;
  node->addWidget(new QLabel("Grinder's node"));
  node->addWidget(node_edit_, 1);

  auto* layout = new QVBoxLayout(this);
  layout->addWidget(state_);
  layout->addWidget(job_, 2);
  layout->addLayout(buttons);
  layout->addWidget(override_);
  layout->addWidget(progress_);
  layout->addWidget(position_);
  layout->addWidget(messages_, 1);
  layout->addLayout(node);
}

void GrindPanel::addButton(QGridLayout& layout, int row, int column, int columns, MachineEvent event,
                           const QString& text, const QString& hint) {
  auto* button = new QPushButton(text);
  button->setObjectName(toString(event));
  button->setToolTip(hint);
  button->setEnabled(false);
  button->setMinimumWidth(10);
  layout.addWidget(button, row, column, 1, columns);
  buttons_[event] = button;
  connect(button, &QPushButton::clicked, this, [this, event] { ask(event); });
}

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
  node_edit_->setText(node);
  planning_ = false;
  sent_.reset();
  job_->forgetPlan();  // it is another machine's
  override_->reset();
  link_.reset();
  try {
    if (node.isEmpty()) throw ros::InvalidNameException("the name is empty");
    link_ = std::make_unique<GrinderLink>(
        node.toStdString(), [this](const std::string& id, const GrindResult& result) { onResult(id, result); });
  } catch (const ros::InvalidNameException& error) {
    say(std::string("grinder's node: ") + error.what());
  }
  refresh();
}

void GrindPanel::refresh() {
  GrinderView view;
  if (link_) {
    link_->deliver();
    view = link_->view();
  }
  std::optional<MachineState> state;
  if (view.state) state = static_cast<MachineState>(view.state->state);
  if (!state && sent_) {  // a grinder that is gone will not tell its end
    sent_.reset();
    job_->forgetPlan();
  }
  state_->show(view, link_ ? QString::fromStdString(link_->name()) : node_);
  job_->refresh(view.state, state && !jobRuns(state) && !planning_ && !sent_);
  refreshButtons(state);
  override_->refresh(view.state);
  progress_->show(view, jobRuns(state));
  position_->show(view);
}

void GrindPanel::refreshButtons(const std::optional<MachineState>& state) {
  for (const auto& [event, button] : buttons_) {
    const bool wanted = event != MachineEvent::kStart || job_->planned();
    button->setEnabled(state && after(*state, event) && wanted);
  }
}

void GrindPanel::ask(MachineEvent event) {
  if (event == MachineEvent::kStart) return start();
  if (event == MachineEvent::kCancel) return link_->cancel();
  link_->request(event, [this](const std::string& refusal) {
    if (!refusal.empty()) say(refusal);
  });
}

void GrindPanel::start() {
  if (const auto goal = job_->takePlanned()) send(*goal);
}

void GrindPanel::plan(const GrindGoal& goal) {
  planning_ = true;
  link_->plan(goal, [this, goal](const Plan::Response& plan) {
    planning_ = false;
    job_->setPlan(goal, plan);
  });
}

void GrindPanel::dryRun(const GrindGoal& goal) {
  GrindGoal dry = goal;
  dry.dry_run = true;
  send(dry);
  if (!sent_) job_->forgetPlan();
}

void GrindPanel::send(const GrindGoal& goal) {
  const auto id = link_->send(goal);
  if (id) sent_ = Sent{*id, goal};
  if (!id) say("the job was not sent: no answer from the grinder " + link_->name());
}

void GrindPanel::onResult(const std::string& id, const GrindResult& result) {
  const bool good = result.error_code == GrindResult::SUCCESSFUL;
  if (sent_ && id == sent_->id) {
    GrindGoal goal = sent_->goal;
    sent_.reset();
    if (goal.dry_run) {
      goal.dry_run = false;
      Plan::Response plan;
      plan.valid = static_cast<std::uint8_t>(good);
      plan.statistics = result.statistics;
      plan.duration = result.statistics.duration;
      plan.reasons = {result.error_string};
      job_->setPlan(goal, plan);
      if (good) say(result.error_string);
      return;
    }
  }
  say(good ? "the job is done" : "the job has ended: " + result.error_string);
}

void GrindPanel::setFeedOverride(double fraction) {
  link_->setFeedOverride(fraction, [this](const std::string& refusal) {
    override_->answered();
    if (!refusal.empty()) say(refusal);
  });
}

void GrindPanel::say(const std::string& text) {
  QString told = QString::fromStdString(inShopUnits(text));
  if (!told.isEmpty()) told[0] = told[0].toUpper();
  messages_->appendPlainText(QTime::currentTime().toString("HH:mm:ss ") + told);
}

}  // namespace flute_grinder

PLUGINLIB_EXPORT_CLASS(flute_grinder::GrindPanel, rviz::Panel)
