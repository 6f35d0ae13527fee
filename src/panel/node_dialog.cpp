#include "panel/node_dialog.h"

#include "panel/beside.h"
#include "panel/panel_button.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

namespace grinder {

NodeDialog::NodeDialog(QWidget& panel) : QDialog(&panel), panel_(panel), name_(new QLineEdit) {
  setObjectName("node_dialog");
  setWindowTitle("Grinder");
  name_->setObjectName("node");
  auto* note = new QLabel("Name of the grinder's node; relative to rviz's namespace without a slash in front.");
  note->setWordWrap(true);
  auto* use = new PanelButton("use_node", "Use it", "Show this grinder in the panel");
  use->setDefault(true);
  auto* close = new PanelButton("close_node", "Close", "Leave the grinder as it is");
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  buttons->addWidget(use);
  buttons->addWidget(close);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(note);
  layout->addWidget(name_);
  layout->addLayout(buttons);
  connect(close, &QPushButton::clicked, this, &QDialog::close);
  connect(use, &QPushButton::clicked, this, [this] {
    hide();
    Q_EMIT chosen(name_->text());
  });
}

void NodeDialog::ask(const QString& node) {
  name_->setText(node);
  moveBeside(*this, panel_);
  show();
  raise();
  name_->setFocus();
}

}  // namespace grinder
