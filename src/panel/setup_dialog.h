#pragma once

#include "flute_grinder/JobProgress.h"
#include "flute_grinder/geometry/setup_solver.h"
#include "panel/question.h"

#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTimer>

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

struct GrindJob;
struct JobSetup;

/// Shows the set-up sheet of a job file, leaving a figure of it as it is if asked to, with the figures that the file
/// has. It writes the set-up into the file if the operator says so twice, and never into that of the job that runs.
/// Solving and writing have a thread of their own, and a master that hangs holds it up for a second at most.
class SetupDialog : public QDialog {
  Q_OBJECT

 public:
  /// Begins to solve.
  /// @param operation of the file, for readJobFile(). @param title what the sheet is of.
  /// @param grinder resolved name of its node; the swivel's range is that of the robot description beside it.
  SetupDialog(const QString& file, const std::string& operation, const QString& title, const std::string& grinder,
              QWidget* parent);
  ~SetupDialog() override;

  /// @param last job in the grinder's journal. @param runs whether it does.
  void refresh(const flute_grinder::JobProgress& last, bool runs);

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
    std::vector<std::string> digests{};  ///< of the operations in the file
    QString changes{};                   ///< in the file
  };

  QWidget* makeButtons();
  void beginToSolve();
  void ask();
  void showQuestion(bool asks);
  void beginToWrite();
  bool isOfLastJob() const;
  Done solve(std::optional<SetupFigure> keep) const;
  std::optional<double> aboveSwivel(const GrindJob& job) const;
  Done write(const JobSetup& setup) const;
  void poll();
  void take(const Done& done);

  const std::string file_, operation_, description_, flange_;
  Done solved_;
  flute_grinder::JobProgress last_;
  bool runs_ = false;
  QPlainTextEdit* sheet_;
  QComboBox* keep_;
  QPushButton* write_;
  QLabel* why_not_;  ///< the file is not written now
  Question* question_;
  QWidget* buttons_;  ///< or the question
  QTimer poll_timer_;
  std::atomic<bool> stop_{false};
  std::future<Done> working_;  ///< last member: its thread uses the others
};

}  // namespace grinder
