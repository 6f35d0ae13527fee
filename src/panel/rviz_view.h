#pragma once

#include "flute_grinder/Cutter.h"

#include <rviz/visualization_manager.h>
#include <QObject>
#include <QTimer>

#include <chrono>
#include <optional>
#include <vector>

namespace grinder {

/// Controls the direction and the frame rate of rviz's view, and what it shows of the cutter. After rviz's *Reset* it
/// has all markers sent again, which come once.
class RvizView : public QObject {
  Q_OBJECT

 public:
  /// @param manager must outlive this object.
  explicit RvizView(rviz::VisualizationManager& manager, QObject* parent);
  /// Makes rviz draw at its own rate again.
  ~RvizView() override;

  /// Looks at the flutes of a cutter from the same side as before, if the view orbits in the frame `work`. Other
  /// views do not follow the work, and stay.
  void lookAt(const flute_grinder::Cutter& cutter);

  /// Has rviz draw at its own frame rate while something moves or the mouse turns the view, and ten times a second
  /// otherwise: without a graphics card each frame costs processor time. To be called often.
  void keepPace(bool moves);

  /// Whether the cutter is shown cut open; nothing until one was shown.
  std::optional<bool> isCutOpen() const;
  void setCutOpen(bool open);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  using Clock = std::chrono::steady_clock;

  void beginFrame();
  void resume();
  void askForMarkers();
  std::vector<rviz::Display*> markers() const;
  /// What shows or hides kCutOut; null until a cutter was shown.
  rviz::Property* cutOut() const;

  rviz::VisualizationManager& manager_;
  Clock::time_point last_motion_ = Clock::now();
  QTimer pause_;             ///< pause between two frames
  double last_elapsed_ = 0;  ///< rviz's clock at the last frame, which Reset puts back [s]
};

}  // namespace grinder
