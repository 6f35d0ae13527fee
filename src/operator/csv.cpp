#include "flute_grinder/operator/csv.h"

#include "flute_grinder/core/units.h"

#include <cerrno>
#include <cstring>

namespace flute_grinder {

using units::kMillimetre;
using units::kMillimetrePerMinute;

CsvFile::CsvFile(const std::string& path, const char* header) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw FileError(path + ": cannot be written: " + std::strerror(errno));
  std::fprintf(file(), "%s\n", header);
}

void CsvFile::close() {
  const bool good = !std::ferror(file());
  if (std::fclose(file_.release()) != 0 || !good) throw FileError(path_ + ": not all could be written");
}

void TableCsv::write(int number, const CurvePoint& point, double theory) {
  std::fprintf(file(), "%d,%.17g,%.17g,%.17g,%.17g\n", number, point.x / kMillimetre, point.a, theory,
               theory - point.a);
}

void SetpointCsv::write(const Setpoint& s) {
  const Axes& p = s.position;
  std::fprintf(file(), "%llu,%.17g,%s,%d,%d,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
               static_cast<unsigned long long>(s.cycle), static_cast<double>(s.cycle) * period_, toString(s.move),
               s.tooth, s.pass, toString(s.step), p[kX] / kMillimetre, p[kY] / kMillimetre, p[kZ] / kMillimetre, p[kA],
               s.path_error, s.feed / kMillimetrePerMinute);
}

}  // namespace flute_grinder
