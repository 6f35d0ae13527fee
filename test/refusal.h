#pragma once

#include "flute_grinder/base/file_error.h"

#include <string>

namespace grinder::test_support {

/// What is said where something is refused; empty where it is not. @tparam Error by default what a file is refused
/// with.
template <typename Error = FileError, typename Call>
std::string refusalOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace grinder::test_support
