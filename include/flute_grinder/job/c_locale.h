#pragma once

#include <clocale>

namespace grinder {

/// As long as it lives, the C functions of its thread write and read numbers with a point, whatever the locale of the
/// process: rviz has the desktop's.
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
