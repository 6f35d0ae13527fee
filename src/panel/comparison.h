#pragma once

#include <QString>
#include <QStringList>

#include <algorithm>
#include <vector>

namespace grinder {

/// A small table for people: figures side by side, with a label in front of each row.
struct Comparison {
  QStringList columns;            ///< heads of the columns after the labels
  std::vector<QStringList> rows;  ///< rows: the label and a cell for each head

  /// The table as HTML, without columns that are empty in every row.
  QString html() const {
    const auto used = [this](int column) {
      return std::any_of(rows.begin(), rows.end(), [column](const QStringList& row) { return !row[column].isEmpty(); });
    };
    const auto cells = [&](const QStringList& texts, const QString& tag) {
      QString line;
      for (int i = 0; i < texts.size(); ++i) {
        if (used(i)) line += "<" + tag + " align='left'>" + texts[i].toHtmlEscaped() + "</" + tag + ">";
      }
      return "<tr>" + line + "</tr>";
    };
    if (rows.empty()) return "";
    QString all = cells(QStringList("") + columns, "th");
    for (const QStringList& row : rows) all += cells(row, "td");
    return "<table border='1' cellspacing='0' cellpadding='2' width='100%'>" + all + "</table>";
  }
};

}  // namespace grinder
