#pragma once

#include "cli/output_file.h"
#include "flute_grinder/curve/odd_even_interpolator.h"
#include "flute_grinder/motion/setpoint.h"

#include <string>

namespace grinder {

/// First line of a CSV file of `grind table`, as in the paper's Table 1.
inline constexpr char kTableColumns[] = "point,x_mm,a_rad,a_theory_rad,error_rad";
/// First line of a CSV file of `grind plan`.
inline constexpr char kSetpointColumns[] =
    "cycle,time_s,move,tooth,pass,step,x_mm,y_mm,z_mm,a_rad,error_rad,feed_mm_min";
/// Columns that `grind run` appends: the position that the drive read one cycle before.
inline constexpr char kActualColumns[] = ",actual_x_mm,actual_y_mm,actual_z_mm,actual_a_rad";

/// Writes lines of comma-separated values with 17 significant digits, enough to restore every double exactly.
class CsvFile {
 public:
  /// @param path the file.
  /// @param header the first line.
  /// @throw FileError see OutputFile.
  CsvFile(std::string path, const std::string& header);

  /// Closes the file; without this call nothing is written. @throw FileError see OutputFile.
  void close();

 protected:
  /// Like printf; close() reports errors.
  void print(const char* format, ...) __attribute__((format(printf, 2, 3)));

 private:
  OutputFile file_;
  int error_ = 0;  ///< errno of the first line that could not be written
};

/// A CSV file with a line for each point of a curve.
class TableCsv : public CsvFile {
 public:
  explicit TableCsv(const std::string& path) : CsvFile(path, kTableColumns) {}
  void write(int number, const CurvePoint& point, double theory);
};

/// A CSV file with a line for each setpoint.
class SetpointCsv : public CsvFile {
 public:
  explicit SetpointCsv(const std::string& path) : CsvFile(path, kSetpointColumns) {}
  /// @param period control cycle [s].
  void write(const Setpoint& setpoint, double period);

 protected:
  SetpointCsv(const std::string& path, const std::string& columns) : CsvFile(path, columns) {}
  /// Writes the fields of a line without its end.
  void writeFields(const Setpoint& setpoint, double period);
};

/// A CSV file with a line for each setpoint and the position that the drive read one cycle before.
class RunCsv : public SetpointCsv {
 public:
  explicit RunCsv(const std::string& path) : SetpointCsv(path, std::string(kSetpointColumns) + kActualColumns) {}
  /// @param actual position read [m], A [rad]. @param period control cycle [s].
  void write(const Setpoint& setpoint, const Axes& actual, double period);
};

}  // namespace grinder
