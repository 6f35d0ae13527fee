#pragma once

#include "flute_grinder/geometry/setup_solver.h"

#include <QComboBox>
#include <QDialog>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTimer>

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace grinder {

struct GrindJob;
struct JobSetup;

/// Shows the set-up sheet of a job file, leaving a figure of it as it is if asked to, and writes the set-up into the
/// file if asked to. Solving and writing have a thread of their own, and a master that hangs holds it up for a second
/// at most.
class SetupDialog : public QDialog {
  Q_OBJECT

 public:
  /// Begins to solve.
  /// @param operation of the file, for readJobFile(). @param title what the sheet is of.
  /// @param grinder resolved name of its node; the swivel's range is that of the robot description beside it.
  SetupDialog(const QString& file, const std::string& operation, const QString& title, const std::string& grinder,
              QWidget* parent);
  ~SetupDialog() override;

 Q_SIGNALS:
  /// The set-up is in the file.
  void written();

 private:
  /// What the thread has done.
  struct Done {
    std::shared_ptr<const JobSetup> setup;  ///< that was solved and can be written
    bool written = false;
    QString text;
    bool good = false;
  };

  void beginToSolve();
  Done solve(std::optional<SetupFigure> keep) const;
  std::optional<double> aboveSwivel(const GrindJob& job) const;
  Done write(const JobSetup& setup) const;
  void poll();
  void take(const Done& done);

  const std::string file_, operation_, description_, flange_;
  std::shared_ptr<const JobSetup> setup_;
  QPlainTextEdit* sheet_;
  QComboBox* keep_;
  QPushButton* write_;
  QTimer poll_timer_;
  std::atomic<bool> stop_{false};
  std::future<Done> working_;  ///< last member: its thread uses the others
};

}  // namespace grinder
