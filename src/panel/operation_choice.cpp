#include "panel/operation_choice.h"

#include "panel/plain_words.h"

#include <QHBoxLayout>
#include <QLabel>

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
  const bool several = operations.size() > 1;
  const int items = several ? static_cast<int>(operations.size()) + 1 : 0;
  // The order of operations is fixed, so an equal number means the same operations.
  if (items == box_->count()) return;
  box_->clear();
  if (several) box_->addItem("choose");
  for (int i = 0; i + 1 < items; ++i) {
    const OperationKind kind = operations[static_cast<std::size_t>(i)].kind;
    box_->addItem(QString::fromStdString(operationEntry(kind)), toString(kind));
  }
  setVisible(several);
}

std::string OperationChoice::chosen() const { return box_->currentData().toString().toStdString(); }

QString OperationChoice::named(const QString& file) const {
  return chosen().empty() ? file : file + ", " + box_->currentText();
}

}  // namespace grinder
