#include "panel/operation_choice.h"

#include "panel/plain_words.h"

#include <QHBoxLayout>
#include <QLabel>

#include <utility>

namespace grinder {

OperationChoice::OperationChoice(QWidget* parent) : QWidget(parent), box_(new QComboBox) {
  box_->setObjectName("operation");
  box_->setToolTip("Which of the file's operations is planned, set up, started and shown");
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(new QLabel("Operation"));
  layout->addWidget(box_, 1);
  hide();
  connect(box_, QOverload<int>::of(&QComboBox::activated), this, &OperationChoice::changed);
}

void OperationChoice::offer(const std::vector<GrindProcess>& operations) {
  std::vector<OperationKind> kinds;
  for (const GrindProcess& operation : operations) kinds.push_back(operation.kind);
  if (std::exchange(kinds_, kinds) == kinds) return;
  const bool several = kinds.size() > 1;
  box_->clear();
  if (several) box_->addItem("choose");
  for (std::size_t i = 0; several && i < kinds.size(); ++i) {
    box_->addItem(QString::fromStdString(operationEntry(static_cast<int>(i), kinds[i])), toString(kinds[i]));
  }
  setVisible(several);
}

std::string OperationChoice::chosen() const { return box_->currentData().toString().toStdString(); }

QString OperationChoice::named(const QString& file) const {
  return chosen().empty() ? file : file + ", " + box_->currentText();
}

}  // namespace grinder
