#pragma once

#include "flute_grinder/base/escaped.h"

#include <stdexcept>
#include <string>

namespace grinder {

/// A file that cannot be opened, read, understood or written; what() has one line per error: file, line, key, value and
/// what is allowed, as far as they are known. It is escaped() except for line ends.
class FileError : public std::runtime_error {
 public:
  explicit FileError(const std::string& text) : std::runtime_error(escaped(text, "\n")) {}
};

/// A file that was opened, but could not be written completely.
class WriteError : public FileError {
 public:
  using FileError::FileError;
};

}  // namespace grinder
