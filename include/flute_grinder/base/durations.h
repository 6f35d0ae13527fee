#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace grinder {

/// A histogram of durations, in classes 4.4 % wide from 1 ns up. Never allocates. Not thread safe.
class Durations {
 public:
  /// @param duration [s]; below 1 ns, negative or NaN counts as 0; above 17 s counts as 17 s in quantiles.
  void add(double duration) noexcept {
    ++total_;
    if (!(duration >= kShortest)) {
      ++zeros_;
      return;
    }
    const double in_classes = std::log2(duration / kShortest) * kClassesPerOctave;
    ++counts_[static_cast<std::size_t>(std::min(in_classes, counts_.size() - 1.0))];
    longest_ = std::max(longest_, duration);
  }

  /// The duration that a fraction of all durations does not exceed, at most 4.4 % too long; 0 if there are none [s].
  /// @param fraction 0 to 1.
  double quantile(double fraction) const noexcept {
    std::uint64_t within = zeros_;
    if (reaches(within, fraction)) return 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      within += counts_[i];
      if (!reaches(within, fraction)) continue;
      const double upper = kShortest * std::exp2((static_cast<double>(i) + 1) / kClassesPerOctave);
      return std::min(upper, longest_);
    }
    return longest_;
  }

  /// The longest duration; 0 if there are none [s].
  double longest() const noexcept { return longest_; }

 private:
  bool reaches(std::uint64_t count, double fraction) const noexcept {
    return static_cast<double>(count) >= fraction * static_cast<double>(total_);
  }

  static constexpr double kShortest = 1e-9;  ///< lower end of the first class [s]
  static constexpr std::size_t kClassesPerOctave = 16;
  static constexpr std::size_t kOctaves = 34;

  std::array<std::uint64_t, kClassesPerOctave * kOctaves> counts_{};
  std::uint64_t zeros_ = 0;
  std::uint64_t total_ = 0;
  double longest_ = 0;
};

}  // namespace grinder
