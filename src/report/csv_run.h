#pragma once

#include "flute_grinder/report/run_file.h"

#include <string>

namespace grinder {

/// The kind of a CSV file by its first line; kOther for any other.
FileKind kindOfCsv(const std::string& first_line);

/// A CSV file of `grind table`, `grind plan` or `grind run`.
class CsvRun : public RunFile {
 public:
  CsvRun(std::string path, FileKind kind);
  void visit(const RowVisitor& visitor) const override;
};

}  // namespace grinder
