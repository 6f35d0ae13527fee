#pragma once

#include "flute_grinder/machine/offset_fit.h"

#include <QPlainTextEdit>
#include <QPushButton>
#include <QWidget>

#include <vector>

namespace flute_grinder {

/// Asks what to do about work offsets that were not set for the job to be started.
class OffsetQuestion : public QWidget {
  Q_OBJECT

 public:
  explicit OffsetQuestion(QWidget* parent = nullptr);

  /// @param misfits at least one.
  void ask(const std::vector<core::OffsetMisfit>& misfits);

 Q_SIGNALS:
  void fitted();  ///< those that can be computed are to be fitted to the job
  void foundRight();
  void declined();

 private:
  QPlainTextEdit* text_;
  QPushButton* fit_;
};

}  // namespace flute_grinder
