#pragma once

#include "flute_grinder/client/grinder_client.h"
#include "flute_grinder/job/valid_job.h"
#include "panel/number_box.h"
#include "panel/section_drawing.h"

#include <QCheckBox>
#include <QLabel>
#include <QWidget>

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace grinder {

/// The part of the panel that shows a section of the cutter that the chosen job grinds, at a chosen X or where the
/// wheel stands, or its end. Sections are computed one at a time in a thread of their own, for at most a tenth of the
/// time, and never while this widget is hidden.
class SectionView : public QWidget {
  Q_OBJECT

 public:
  explicit SectionView(QWidget* parent = nullptr);

  /// @param job the chosen job; null if none is chosen, or if it is wrong.
  void refresh(const GrinderView& view, const std::shared_ptr<const GrindJob>& job);

 private:
  using Clock = std::chrono::steady_clock;
  using Job = std::shared_ptr<const GrindJob>;
  struct Wanted {
    Job job;
    double x = 0;                      ///< X of the section [mm]
    std::optional<ValidJob> with_law;  ///< result of withLaws(); nothing if not computed yet
    bool operator==(const Wanted& o) const { return job == o.job && x == o.x; }
  };
  struct Computed {
    Job job;
    std::shared_ptr<const CutterSection> section;  ///< null if the section cannot be computed
    QString text;                                  ///< figures of the section, or why there is none
    Clock::duration took{};
    std::optional<ValidJob> with_law;  ///< see Wanted::with_law
  };

  static Computed computed(const Wanted& wanted);
  void take(const Computed& computed);
  void setJob(const Job& job);
  QString whyNothing(const GrinderView& view) const;
  void follow(double x);
  void show(const std::shared_ptr<const CutterSection>& section, const QString& text);

  Job job_;
  std::optional<ValidJob> with_law_;  ///< see Wanted::with_law
  std::string digest_;                ///< digest of the job
  std::optional<Wanted> wanted_;
  NumberBox* x_;
  QCheckBox* follow_;
  SectionDrawing* drawing_;
  QLabel* figures_;
  Clock::time_point earliest_;  ///< earliest time of the next section
  std::future<Computed> computing_;
};

}  // namespace grinder
