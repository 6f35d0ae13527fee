#include "panel_fixture.h"

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QDir>
#include <QFile>
#include <QLayout>
#include <QProgressBar>
#include <QTabBar>
#include <QTabWidget>

#include <vector>

namespace flute_grinder {

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
    const bool scrolls =
        qobject_cast<QPlainTextEdit*>(widget->parentWidget()) ||
        (widget->parentWidget() && qobject_cast<QPlainTextEdit*>(widget->parentWidget()->parentWidget()));
    const bool edits = qobject_cast<QAbstractSpinBox*>(widget->parentWidget());
    const bool groups = widget->layout() || qobject_cast<QTabWidget*>(widget);
    if (widget->isVisible() && !scrolls && !edits && !groups) found.push_back(widget);
  }
  return found;
}

void expectRoomForText(QWidget& widget) {
  if (auto* label = qobject_cast<QLabel*>(&widget)) {
    if (label->wordWrap()) {
      EXPECT_LE(label->heightForWidth(label->width()), label->height())
          << nameOf(widget) << label->text().toStdString();
    } else {
      EXPECT_LE(label->fontMetrics().horizontalAdvance(label->text()), label->contentsRect().width())
          << nameOf(widget) << label->text().toStdString();
    }
  } else if (auto* button = qobject_cast<QAbstractButton*>(&widget)) {
    EXPECT_LE(button->fontMetrics().horizontalAdvance(button->text()) + 6, button->width()) << nameOf(widget);
    EXPECT_LE(button->fontMetrics().height(), button->height()) << nameOf(widget);
  } else if (auto* bar = qobject_cast<QProgressBar*>(&widget)) {
    EXPECT_FALSE(bar->isTextVisible()) << nameOf(widget) << ": over the bar's end it is hard to read";
  }
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

Names Panel::enabledRequests() {
  Names names;
  for (const std::string& name : kRequests) {
    if (enabled(name.c_str())) names.insert(name);
  }
  return names;
}

void Panel::openTab(const QString& title) {
  QTabBar& bar = *the<QTabWidget>("tabs").tabBar();
  for (int tab = 0; tab < bar.count(); ++tab) {
    if (bar.tabText(tab) == title) QTest::mouseClick(&bar, Qt::LeftButton, {}, bar.tabRect(tab).center());
  }
  EXPECT_EQ(bar.tabText(bar.currentIndex()), title);
}

void Panel::picture(const std::string& name) {
  SCOPED_TRACE("picture " + name);
  EXPECT_EQ(panel_->width(), kWidth) << "it wants more room";
  EXPECT_EQ(panel_->height(), kHeight) << "it wants more room";
  // A change of a text is laid out level by level.
  for (int level = 0; level < 5; ++level) QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
  const std::vector<QWidget*> widgets = leaves(*panel_);
  EXPECT_GT(widgets.size(), 20U);
  std::vector<QRect> taken;
  for (QWidget* widget : widgets) {
    expectRoomForText(*widget);
    const QRect place(widget->mapTo(panel_.get(), QPoint(0, 0)), widget->size());
    EXPECT_TRUE(panel_->rect().contains(place)) << nameOf(*widget);
    for (const QRect& other : taken) EXPECT_FALSE(place.intersects(other)) << nameOf(*widget);
    taken.push_back(place);
  }
  QDir().mkpath(SCREENSHOTS);
  EXPECT_TRUE(panel_->grab().save(QString(SCREENSHOTS "/panel_%1.png").arg(QString::fromStdString(name))));
}

}  // namespace flute_grinder
