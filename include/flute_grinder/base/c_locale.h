#pragma once

#include <clocale>

namespace grinder {

/// During its lifetime, the C functions of the calling thread read and write numbers with a decimal point, whatever the
/// locale of the process (rviz uses the desktop's).
class CLocale {
 public:
  CLocale() noexcept : before_(::uselocale(c())) {}
  ~CLocale() { ::uselocale(before_); }
  CLocale(const CLocale&) = delete;
  CLocale& operator=(const CLocale&) = delete;

 private:
  static locale_t c() noexcept {
    static const locale_t the = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return the;
  }

  const locale_t before_;
};

}  // namespace grinder
