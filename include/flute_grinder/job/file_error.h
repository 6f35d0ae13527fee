#pragma once

#include <stdexcept>

namespace grinder {

/// A file that cannot be opened, read or written; what() names it.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that could be opened, but not written to its end.
class WriteError : public FileError {
 public:
  using FileError::FileError;
};

}  // namespace grinder
