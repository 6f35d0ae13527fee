#pragma once

#include "flute_grinder/JobProgress.h"
#include "flute_grinder/job/job_file.h"
#include "panel/question.h"

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

/// Solves and shows the set-up sheet of a job file beside the set-up that the job has. Writes the set-up file if the
/// operator confirms it twice, but not while the job runs. Solving and writing have a thread of their own, which
/// waits for a hanging master for a second at most.
class SetupDialog : public QDialog {
  Q_OBJECT

 public:
  /// Begins to solve.
  /// @param operation operation of the file, for readJobToSetUp(). @param title title of the sheet.
  /// @param grinder resolved name of the node; the swivel's range comes from the robot description in its namespace.
  SetupDialog(const QString& file, const std::string& operation, const QString& title, const std::string& grinder,
              QWidget* parent);
  ~SetupDialog() override;

  /// @param last last job in the grinder's journal. @param runs whether that job is running.
  void refresh(const flute_grinder::JobProgress& last, bool runs);

 Q_SIGNALS:
  /// The set-up file has been written.
  void written();

 private:
  /// The result of the thread.
  struct Done {
    std::shared_ptr<const GrindJob> solved;  ///< job with a set-up that can be written
    bool written = false;
    QString text;
    bool good = false;
    std::vector<std::string> digests{};  ///< digests of the operations in the file
    QString changes{};                   ///< changes of the set-up
    JobToSetUp asked{};                  ///< job as asked
  };

  QWidget* makeButtons();
  void beginToSolve();
  void ask();
  void showQuestion(bool asks);
  void beginToWrite();
  bool isOfLastJob() const;
  Done solve() const;
  std::optional<double> aboveSwivel(const JobFile& asked, const GrindJob& job) const;
  Done write(const JobToSetUp& asked, const GrindJob& solved) const;
  void poll();
  void take(const Done& done);

  const std::string file_, operation_, description_, flange_;
  Done solved_;
  flute_grinder::JobProgress last_;
  bool runs_ = false;
  QPlainTextEdit* sheet_;
  QPushButton* write_;
  QLabel* why_not_;  ///< why the file is not written now
  Question* question_;
  QWidget* buttons_;  ///< buttons, in place of the question
  QTimer poll_timer_;
  std::atomic<bool> stop_{false};
  std::future<Done> working_;  ///< last member: its thread uses the others
};

}  // namespace grinder
