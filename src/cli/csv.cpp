#include "cli/csv.h"

#include "flute_grinder/base/c_locale.h"
#include "flute_grinder/base/units.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>

namespace grinder {

using units::kMillimetre;
using units::kMillimetrePerMinute;

CsvFile::CsvFile(std::string path, const std::string& header) : file_(std::move(path)) {
  print("%s\n", header.c_str());
}

void CsvFile::print(const char* format, ...) {
  const CLocale with_points;
  va_list arguments;
  va_start(arguments, format);
  if (std::vfprintf(file_.stream(), format, arguments) < 0 && error_ == 0) error_ = errno;
  va_end(arguments);
}

void CsvFile::close() { file_.close(error_); }

void TableCsv::write(int number, const CurvePoint& point, double theory) {
  print("%d,%.17g,%.17g,%.17g,%.17g\n", number, point.x / kMillimetre, point.a, theory, theory - point.a);
}

void SetpointCsv::writeFields(const Setpoint& s, double period) {
  const Axes& p = s.position;
  print("%llu,%.17g,%s,%d,%d,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", static_cast<unsigned long long>(s.cycle),
        static_cast<double>(s.cycle) * period, toString(s.move), s.tooth, s.pass, toString(s.step), p[kX] / kMillimetre,
        p[kY] / kMillimetre, p[kZ] / kMillimetre, p[kA], s.path_error, s.feed / kMillimetrePerMinute);
}

void SetpointCsv::write(const Setpoint& setpoint, double period) {
  writeFields(setpoint, period);
  print("\n");
}

void RunCsv::write(const Setpoint& setpoint, const Axes& actual, double period) {
  writeFields(setpoint, period);
  print(",%.17g,%.17g,%.17g,%.17g\n", actual[kX] / kMillimetre, actual[kY] / kMillimetre, actual[kZ] / kMillimetre,
        actual[kA]);
}

}  // namespace grinder
