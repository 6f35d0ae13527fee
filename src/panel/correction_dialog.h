#pragma once

#include "flute_grinder/SetOffsets.h"
#include "flute_grinder/WorkOffsets.h"
#include "flute_grinder/record/correction.h"
#include "panel/question.h"

#include <QDialog>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>

#include <atomic>
#include <cstdint>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Keeps what was measured of the last tool of a job in its record, shows what the next tool would be like as the zero
/// points are and as they would be corrected, and corrects them once the operator confirms it. Reading, computing and
/// writing have a thread of their own, which waits for a hanging master for a second at most in each of its calls. The
/// records are sought where the grinder keeps them, thus on its computer.
class CorrectionDialog : public QDialog {
  Q_OBJECT

 public:
  /// Begins to read the records.
  /// @param operation operation of the file, for readJobFile(). @param title title of the job.
  /// @param grinder resolved name of the node, whose parameters say where its records are.
  CorrectionDialog(const QString& file, const std::string& operation, const QString& title, const std::string& grinder,
                   QWidget* parent);
  ~CorrectionDialog() override;

  /// @param offsets present work offsets; nothing if unknown. @param may whether they can be set now.
  void refresh(const std::optional<flute_grinder::WorkOffsets>& offsets, bool may);

  /// Shows the answer to what was wanted. @param refusal empty if it was done.
  void showAnswer(const std::string& refusal);

 Q_SIGNALS:
  void wanted(const flute_grinder::SetOffsets::Request& request);

 private:
  /// The result of the thread.
  struct Done {
    std::optional<SetupFindings> found{};  ///< nothing if nothing is known, with the reason in `text`
    Correction correction{};
    ToolNumber tool{};  ///< tool whose figures are entered; the last if none are
    bool kept = false;  ///< whether what was entered is in its record
    OffsetBasis basis{};
    QString text{};
    bool good = false;
  };

  /// A figure in the table.
  struct Row {
    FigureAt at;
    QLineEdit* measured;
  };

  void layOut();
  void begin(std::vector<MeasuredFigure> figures);
  /// @param tool number of the tool that was measured; 0 for the last.
  Done work(const std::vector<MeasuredFigure>& figures, std::uint64_t tool) const;
  void poll();
  void take(Done done);
  std::map<std::string, QString> entered() const;
  void showTable(const std::map<std::string, QString>& entered);
  void keep();
  bool isSet() const;
  Turns present() const;
  /// @param back_to work offsets that can be set back to afterwards.
  void ask(const Turns& offset, const QString& text, const std::optional<Turns>& back_to);
  void showText(const QString& text, bool good);
  void showQuestion(bool asks);

  const std::string file_, operation_, grinder_;
  Done done_;
  std::optional<WorkOffsets> offsets_;
  bool may_ = true;
  bool failed_ = false;           ///< whether the records could not be read at last
  std::optional<Turns> back_to_;  ///< for `before_`, once what is under way is done
  std::optional<Turns> before_;   ///< work offsets of Y and Z before the last correction from this dialog
  std::vector<Row> rows_;
  QLabel* tool_;
  QWidget* table_ = nullptr;
  QLabel* says_;
  QPushButton* keep_;
  QPushButton* apply_;
  QPushButton* back_;
  Question* question_;
  QWidget* buttons_;
  QTimer poll_timer_;
  std::atomic<bool> stop_{false};
  std::future<Done> working_;  ///< last member: its thread uses the others
};

}  // namespace grinder
