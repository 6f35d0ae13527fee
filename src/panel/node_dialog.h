#pragma once

#include <QDialog>
#include <QLineEdit>

namespace grinder {

/// Asks for the name of the grinder's node, beside the panel. Not modal.
class NodeDialog : public QDialog {
  Q_OBJECT

 public:
  explicit NodeDialog(QWidget& panel);

  /// @param node the present name, as entered.
  void ask(const QString& node);

 Q_SIGNALS:
  void chosen(const QString& node);

 private:
  QWidget& panel_;
  QLineEdit* name_;
};

}  // namespace grinder
