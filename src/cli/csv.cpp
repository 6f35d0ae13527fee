#include "cli/csv.h"

#include "flute_grinder/curve/units.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>

namespace grinder {

using units::kMillimetre;
using units::kMillimetrePerMinute;

CsvFile::CsvFile(std::string path, std::string header) : path_(std::move(path)), header_(std::move(header)) {
  constexpr int flags = O_WRONLY | O_CREAT | O_CLOEXEC;
  constexpr mode_t mode = 0666;
  int descriptor = ::open(path_.c_str(), flags | O_EXCL, mode);
  created_ = descriptor >= 0;
  if (errno == EEXIST && !created_) descriptor = ::open(path_.c_str(), flags, mode);
  if (descriptor >= 0) file_.reset(::fdopen(descriptor, "w"));
  if (!file_) throw FileError(path_ + ": cannot be written: " + std::strerror(errno));
}

CsvFile::~CsvFile() {
  if (created_ && !begun_) ::unlink(path_.c_str());
}

void CsvFile::begin() {
  if (begun_) return;
  begun_ = true;
  // EINVAL: a pipe or a device cannot be truncated.
  if (::ftruncate(::fileno(file_.get()), 0) != 0 && errno != EINVAL) error_ = errno;
  print("%s\n", header_.c_str());
}

void CsvFile::print(const char* format, ...) {
  begin();
  va_list arguments;
  va_start(arguments, format);
  if (std::vfprintf(file_.get(), format, arguments) < 0 && error_ == 0) error_ = errno;
  va_end(arguments);
}

void CsvFile::close() {
  begin();
  if (std::fclose(file_.release()) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) throw WriteError(path_ + ": write failed: " + std::strerror(error_));
}

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
