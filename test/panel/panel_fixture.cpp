#include "panel_fixture.h"

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QDir>
#include <QFile>
#include <QLayout>
#include <QMouseEvent>
#include <QScrollArea>
#include <QScrollBar>
#include <QTabBar>
#include <QTabWidget>
#include <QTextEdit>

#include <vector>

namespace grinder {

namespace {

constexpr int kWidth = 330, kHeight = 680;

pluginlib::ClassLoader<rviz::Panel>& loader() {
  // Never destroyed, since the panels' library must outlive Qt.
  static auto* the = new pluginlib::ClassLoader<rviz::Panel>("rviz", "rviz::Panel");
  return *the;
}

std::string nameOf(const QWidget& widget) {
  return std::string(widget.metaObject()->className()) + " '" + widget.objectName().toStdString() + "'";
}

/// The visible widgets that draw something of their own.
std::vector<QWidget*> leaves(QWidget& panel) {
  std::vector<QWidget*> found;
  for (QWidget* widget : panel.findChildren<QWidget*>()) {
    const auto isText = [](const QWidget* parent) {
      return qobject_cast<const QPlainTextEdit*>(parent) || qobject_cast<const QTextEdit*>(parent);
    };
    const bool scrolls =
        widget->parentWidget() && (isText(widget->parentWidget()) || isText(widget->parentWidget()->parentWidget()));
    const bool edits = qobject_cast<QAbstractSpinBox*>(widget->parentWidget());
    const bool pages = qobject_cast<QScrollArea*>(widget) || qobject_cast<QScrollArea*>(widget->parentWidget());
    const bool groups = widget->layout() || qobject_cast<QTabWidget*>(widget) || pages;
    // What is scrolled away is seen when it is wanted.
    const bool seen = !widget->visibleRegion().isEmpty();
    if (seen && !scrolls && !edits && !groups) found.push_back(widget);
  }
  return found;
}

/// What of a widget's text does not fit; empty if all does.
std::string lacksRoom(QWidget& widget) {
  if (auto* label = qobject_cast<QLabel*>(&widget)) {
    const bool fits = label->wordWrap()
                          ? label->heightForWidth(label->width()) <= label->height()
                          : label->fontMetrics().size(0, label->text()).width() <= label->contentsRect().width();
    if (!fits) return "no room for the text of " + nameOf(widget) + ": " + label->text().toStdString() + '\n';
  } else if (auto* button = qobject_cast<QAbstractButton*>(&widget)) {
    const QSize text(button->fontMetrics().horizontalAdvance(button->text()) + 6, button->fontMetrics().height());
    if (button->size().expandedTo(text) != button->size()) return "no room for the text of " + nameOf(widget) + '\n';
  } else if (auto* bar = qobject_cast<QProgressBar*>(&widget)) {
    if (bar->isTextVisible()) return nameOf(widget) + ": over the bar's end a text is hard to read\n";
  }
  return "";
}

/// What is wrong with how a panel or a dialog looks, a line each.
std::string wrongs(QWidget& panel) {
  std::string found;
  const bool has_its_size = qobject_cast<QDialog*>(&panel) != nullptr || panel.size() == QSize(kWidth, kHeight);
  if (!has_its_size) found += "it wants more room\n";
  const std::vector<QWidget*> widgets = leaves(panel);
  if (widgets.size() <= 20) found += "it shows next to nothing\n";
  std::vector<QRect> taken;
  for (QWidget* widget : widgets) {
    found += lacksRoom(*widget);
    const QRect place = widget->visibleRegion().boundingRect().translated(widget->mapTo(&panel, QPoint(0, 0)));
    if (!panel.rect().contains(place)) found += nameOf(*widget) + " is cut off\n";
    for (const QRect& other : taken) {
      if (place.intersects(other)) found += nameOf(*widget) + " covers another\n";
    }
    taken.push_back(place);
  }
  return found;
}

}  // namespace

QString changedJob(const QString& job, const QString& path,
                   const std::vector<std::pair<QByteArray, QByteArray>>& changes) {
  QFile original(job);
  EXPECT_TRUE(original.open(QFile::ReadOnly));
  QByteArray text = original.readAll();
  for (const auto& [from, to] : changes) {
    EXPECT_EQ(text.count(from), 1) << from.toStdString();
    text.replace(from, to);
  }
  text.replace("../wheels", kPackage.toUtf8() + "/wheels");
  const QFileInfo from(job), to(path);
  QFile setup(from.path() + "/" + from.completeBaseName() + ".setup.yaml");
  if (setup.open(QFile::ReadOnly)) {
    QFile copy(to.path() + "/" + QFileInfo(setup).fileName());
    const QByteArray solved = setup.readAll().replace(from.fileName().toUtf8(), to.fileName().toUtf8());
    EXPECT_TRUE(copy.open(QFile::WriteOnly) && copy.write(solved) == solved.size());
  }
  QFile file(path);
  EXPECT_TRUE(file.open(QFile::WriteOnly) && file.write(text) == text.size());
  return path;
}

Panel::Panel(const QString& node, const QString& job)
    : panel_(loader().createUnmanagedInstance("flute_grinder/GrindPanel")) {
  rviz::Config config;
  config.mapSetValue("Node", node);
  config.mapSetValue("Job", job);
  panel_->load(config);
  // What it gets where it is docked in a window of 1280 x 800.
  panel_->resize(kWidth, kHeight);
  panel_->show();
  EXPECT_TRUE(QTest::qWaitForWindowExposed(panel_.get(), kPatience));
}

void Panel::plan() {
  WAIT_FOR(enabled("plan"));
  click("plan");
  WAIT_FOR(enabled("start"));
}

std::string Panel::texts() {
  std::string all;
  for (const auto* widget : panel_->findChildren<QWidget*>()) {
    const QString text = widget->property(widget->property("plainText").isValid() ? "plainText" : "text").toString();
    if (widget->isVisible() && !text.isEmpty()) all += (widget->objectName() + ": " + text + '\n').toStdString();
  }
  return all;
}

void Panel::press(const char* name) {
  const auto offered = [&] {
    // An answer to a question is taken once its end was in sight.
    for (auto* text : panel_->findChildren<QTextEdit*>()) {
      if (text->isVisible()) text->verticalScrollBar()->setValue(text->verticalScrollBar()->maximum());
    }
    return isVisible(name) && enabled(name);
  };
  EXPECT_TRUE(QTest::qWaitFor(offered, kPatience)) << name << " is not offered; the panel says\n" << texts();
  click(name);
}

void Panel::doubleClick(QAbstractButton& button, int pause) {
  constexpr int kDesktopsDoubleClick = 400;
  for (auto* page : panel_->findChildren<QScrollArea*>()) {
    if (page->isAncestorOf(&button)) page->ensureWidgetVisible(&button);
  }
  const QPoint place = button.mapTo(panel_.get(), button.rect().center());
  const int begun = ++QTest::lastMouseTimestamp;
  clickAt(place, QEvent::MouseButtonPress);
  QTest::lastMouseTimestamp = begun + pause;
  clickAt(place, pause <= kDesktopsDoubleClick ? QEvent::MouseButtonDblClick : QEvent::MouseButtonPress);
  QTest::lastMouseTimestamp += 1000;
}

void Panel::clickAt(QPoint place, QEvent::Type press) {
  QWidget* widget = panel_->childAt(place);
  ASSERT_TRUE(widget);
  for (const QEvent::Type type : {press, QEvent::MouseButtonRelease}) {
    QMouseEvent event(type, widget->mapFrom(panel_.get(), place), panel_->mapToGlobal(place), Qt::LeftButton,
                      type == press ? Qt::LeftButton : Qt::NoButton, Qt::NoModifier);
    event.setTimestamp(static_cast<ulong>(QTest::lastMouseTimestamp));
    QApplication::sendEvent(widget, &event);
  }
}

Names Panel::enabledOf(const Names& buttons) {
  Names names;
  for (const std::string& name : buttons) {
    if (enabled(name.c_str())) names.insert(name);
  }
  return names;
}

void Panel::chooseOperation(const QString& operation) {
  auto& box = the<QComboBox>("operation");
  for (int i = 0; i < box.count() && box.currentText() != operation; ++i) QTest::keyClick(&box, Qt::Key_Down);
  EXPECT_EQ(box.currentText(), operation);
}

void Panel::openTab(const QString& title) {
  QTabBar& bar = *the<QTabWidget>("tabs").tabBar();
  for (int tab = 0; tab < bar.count(); ++tab) {
    if (bar.tabText(tab) == title) QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.tabRect(tab).center());
  }
  EXPECT_EQ(bar.tabText(bar.currentIndex()), title);
}

void Panel::tick(const char* name) {
  auto& box = the<QCheckBox>(name);
  QTest::mouseClick(&box, Qt::LeftButton, {}, QPoint(8, box.height() / 2));
}

void Panel::enterNode(const QString& name) {
  openTab("View");
  click("choose_node");
  auto& node = the<QLineEdit>("node");
  node.clear();
  QTest::keyClicks(&node, name);
  QTest::keyClick(&node, Qt::Key_Return);
}

QFileDialog* Panel::fileDialog() {
  click("choose");
  QFileDialog* dialog = nullptr;
  EXPECT_TRUE(QTest::qWaitFor([&] { return dialog = panel_->findChild<QFileDialog*>(); }, kPatience));
  return dialog;
}

void Panel::enter(QFileDialog& dialog, const QString& file) {
  auto* name = dialog.findChild<QLineEdit*>("fileNameEdit");
  ASSERT_TRUE(name);
  name->setText(file);
  QTest::keyClick(name, Qt::Key_Return);
}

::testing::AssertionResult Panel::has(const std::string& whole, const std::string& part) {
  const bool found = whole.find(part) != std::string::npos;
  return (found ? ::testing::AssertionSuccess() : ::testing::AssertionFailure()) << '\'' << part << "' in: " << whole;
}

void Panel::picture(const std::string& name, const char* dialog) {
  QWidget& shown = dialog != nullptr ? the<QWidget>(dialog) : *panel_;
  SCOPED_TRACE("picture " + name);
  // A change of a text is laid out level by level, and values go on coming.
  std::string wrong;
  const auto looksGood = [&] { return (wrong = wrongs(shown)).empty(); };
  EXPECT_TRUE(QTest::qWaitFor(looksGood, kPatience)) << wrong;
  const QString folder = qEnvironmentVariable("SCREENSHOTS", "screenshots");
  QDir().mkpath(folder);
  EXPECT_TRUE(shown.grab().save(folder + "/panel_" + QString::fromStdString(name) + ".png"));
}

}  // namespace grinder
