#pragma once

#include "flute_grinder/job/grind_job.h"

#include <QComboBox>
#include <QWidget>

#include <string>
#include <vector>

namespace grinder {

/// The choice of one of a job file's operations. It is hidden if there is only one. If there are several, none is
/// chosen at first.
class OperationChoice : public QWidget {
  Q_OBJECT

 public:
  explicit OperationChoice(QWidget* parent = nullptr);

  /// Offers the operations of a file. The choice stays if they are the same as before.
  void offer(const std::vector<GrindProcess>& operations);
  /// @param operation one of the operations offered.
  void choose(OperationKind operation) { box_->setCurrentIndex(box_->findData(toString(operation))); }

  /// Whether there are several operations, and none is chosen.
  bool isMissing() const { return box_->count() > 0 && box_->currentIndex() == 0; }
  /// The chosen operation, for readJobFile(); empty if there is only one, or none is chosen.
  std::string chosen() const;
  /// The name of a file with the chosen operation, e.g. "reamer.yaml, 2 primary relief".
  QString named(const QString& file) const;

 Q_SIGNALS:
  /// The operator has chosen.
  void changed();

 private:
  QComboBox* box_;
  std::vector<OperationKind> kinds_;  ///< kinds of the operations offered
};

}  // namespace grinder
