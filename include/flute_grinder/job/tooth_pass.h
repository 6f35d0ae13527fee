#pragma once

namespace grinder {

constexpr int kMaxTeeth = 64;
constexpr int kMaxPasses = 10000;  ///< maximum number of passes per tooth

/// A pass of a tooth.
struct ToothPass {
  int tooth = 0;  ///< from 0
  int pass = 0;   ///< from 0

  bool operator==(const ToothPass& other) const { return tooth == other.tooth && pass == other.pass; }
  bool operator!=(const ToothPass& other) const { return !(*this == other); }
};

}  // namespace grinder
