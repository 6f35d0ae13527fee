#pragma once

#include <stdlib.h>

#include <clocale>
#include <string>

namespace grinder::test_support {

/// Lets a program that asks for the environment's locale, as those with Qt do, have one with a comma in its numbers,
/// also on a computer without that. The C library's messages stay English.
inline void setGermanEnvironment() {
  ::setenv("LOCPATH", GERMAN_LOCALE_FOLDER, 1);
  ::setenv("LC_ALL", "de_DE.UTF-8", 1);
  ::setenv("LANGUAGE", "en", 1);
}

inline bool hasComma() { return std::string(std::localeconv()->decimal_point) == ","; }

/// The same at once, for this process; the locale goes with this object.
class German {
 public:
  German() {
    setGermanEnvironment();
    std::setlocale(LC_ALL, "");
  }
  ~German() { std::setlocale(LC_ALL, "C"); }
  German(const German&) = delete;
  German& operator=(const German&) = delete;
};

}  // namespace grinder::test_support
