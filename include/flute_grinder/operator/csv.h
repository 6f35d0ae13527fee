#pragma once

#include "flute_grinder/core/odd_even_interpolator.h"
#include "flute_grinder/core/setpoint.h"

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

namespace flute_grinder {

/// A file that cannot be opened or written.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes lines of comma-separated values with 17 significant digits, which is every bit of a double.
class CsvFile {
 public:
  /// @param path the file, overwritten.
  /// @param header its first line.
  /// @throw FileError
  CsvFile(const std::string& path, const char* header);

  /// Closes the file. @throw FileError if not all could be written.
  void close();

 protected:
  std::FILE* file() { return file_.get(); }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// `point,x_mm,a_rad,a_theory_rad,error_rad`, as of the paper's Table 1.
class TableCsv : public CsvFile {
 public:
  explicit TableCsv(const std::string& path) : CsvFile(path, "point,x_mm,a_rad,a_theory_rad,error_rad") {}
  void write(int number, const CurvePoint& point, double theory);
};

/// `cycle,time_s,move,tooth,pass,step,x_mm,y_mm,z_mm,a_rad,error_rad,feed_mm_min`, a line for each setpoint.
class SetpointCsv : public CsvFile {
 public:
  /// @param period control cycle [s].
  SetpointCsv(const std::string& path, double period)
      : CsvFile(path, "cycle,time_s,move,tooth,pass,step,x_mm,y_mm,z_mm,a_rad,error_rad,feed_mm_min"),
        period_(period) {}
  void write(const Setpoint& setpoint);

 private:
  double period_;
};

}  // namespace flute_grinder
