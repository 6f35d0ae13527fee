#pragma once

#include <gtest/gtest.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <rviz/panel.h>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QTemporaryDir>
#include <QtTest>
#include <pluginlib/class_loader.hpp>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace grinder {

/// Much longer than anything takes, even on a host that stalls [ms].
constexpr int kPatience = 60000;

/// Waits for a condition, and lets the panel live meanwhile.
#define WAIT_FOR(condition) ASSERT_TRUE(QTest::qWaitFor([&] { return bool(condition); }, kPatience)) << #condition

inline const QString kPackage = QString::fromStdString(ros::package::getPath("flute_grinder"));
inline const QString kPaper = kPackage + "/test/jobs/paper.yaml";

using Names = std::set<std::string>;

/// The ten buttons that ask for a change of the machine's state.
inline const Names kRequests{"enable", "disable", "home", "start",  "hold",
                             "resume", "retract", "lift", "cancel", "reset"};

/// Writes a copy of a job file with other values, the same wheel files, and a copy of its set-up file. @return its
/// path.
QString changedJob(const QString& job, const QString& path,
                   const std::vector<std::pair<QByteArray, QByteArray>>& changes);

/// See jobDigest(). @param operation as of readJobFile().
std::string digestOf(const QString& job, const std::string& operation = "");

/// The panel as rviz makes it: from its plugin, and with a configuration.
class Panel {
 public:
  /// @param node name of the grinder's node. @param job file, or empty.
  explicit Panel(const QString& node, const QString& job = "");

  rviz::Panel& widget() { return *panel_; }
  template <typename Widget>
  Widget& the(const char* name) {
    auto* found = panel_->findChild<Widget*>(name);
    if (!found) throw std::runtime_error(std::string("the panel has no ") + name);
    return *found;
  }
  void click(const char* name) { QTest::mouseClick(&the<QPushButton>(name), Qt::LeftButton); }
  /// Plans the job, once it may, and waits until it may be started.
  void plan();
  /// Clicks a button, once it takes clicks.
  void press(const char* name);
  /// Clicks a button, and once more at the same place. @param pause between them, as the events have it [ms].
  void doubleClick(QAbstractButton& button, int pause);
  std::string label(const char* name) { return the<QLabel>(name).text().toStdString(); }
  std::string text(const char* name) { return the<QWidget>(name).property("plainText").toString().toStdString(); }
  /// Whether a text of the panel, or a label of it, has this in it.
  ::testing::AssertionResult says(const char* name, const std::string& part) { return has(text(name), part); }
  ::testing::AssertionResult shows(const char* name, const std::string& part) { return has(label(name), part); }
  /// Whether something of this name is in sight; the answers to a question are there while it is asked only.
  bool isVisible(const char* name) {
    const auto* widget = panel_->findChild<QWidget*>(name);
    return widget && widget->isVisible();
  }
  /// All texts in sight, with the names of what shows them.
  std::string texts();
  bool enabled(const char* name) { return the<QWidget>(name).isEnabled(); }
  std::string state() { return label("state"); }
  /// Shows one of the tabs by a click.
  void openTab(const QString& title);
  /// Those of some buttons that are enabled.
  Names enabledOf(const Names& buttons);
  Names enabledRequests() { return enabledOf(kRequests); }
  /// Chooses one of the job's operations, as the keys do.
  void chooseOperation(const QString& operation);

  /// Looks for what is wrong with the picture of the panel, or of one of its dialogs, and keeps it as panel_NAME.png in
  /// the folder SCREENSHOTS of the environment.
  void picture(const std::string& name, const char* dialog = nullptr);

  /// Clicks the tick of a check box.
  void tick(const char* name);
  /// Enters the name of a grinder's node.
  void enterNode(const QString& name);
  /// Opens the dialog for a job file.
  QFileDialog* fileDialog();
  static void enter(QFileDialog& dialog, const QString& file);

 private:
  static ::testing::AssertionResult has(const std::string& whole, const std::string& part);
  void clickAt(QPoint place, QEvent::Type press);

  std::unique_ptr<rviz::Panel> panel_;
};

}  // namespace grinder
