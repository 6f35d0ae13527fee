#pragma once

#include "flute_grinder/base/file_error.h"

#include <string>

namespace grinder::test_support {

/// What is said of a file where reading or editing it is refused; empty where it is not.
template <typename Call>
std::string refusalOf(const Call& call) {
  try {
    call();
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace grinder::test_support
