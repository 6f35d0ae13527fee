#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <string>
#include <string_view>

namespace grinder {

/// A text from a drive's plugin, which may pass null.
inline std::string_view textOrNone(const char* text) noexcept { return text ? text : "no text"; }
/// The text of an exception that a drive's plugin threw; its what() may be null.
inline std::string_view textOrNone(const std::exception& error) noexcept {
  const std::string_view text = textOrNone(error.what());
  return text.empty() ? textOrNone(nullptr) : text;
}

/// A short text that is copied without the heap; longer texts are truncated. Real-time safe.
class FaultText {
 public:
  static constexpr std::size_t kMost = 95;  ///< characters

  FaultText() = default;
  FaultText& operator=(std::string_view text) noexcept {
    size_ = 0;
    return *this += text;
  }
  FaultText& operator=(const char* text) noexcept { return *this = textOrNone(text); }
  FaultText& operator+=(const char* text) noexcept { return *this += textOrNone(text); }
  FaultText& operator+=(std::string_view text) noexcept {
    const std::size_t count = std::min(text.size(), kMost - size_);
    std::copy_n(text.begin(), count, text_.begin() + size_);
    size_ = static_cast<unsigned char>(size_ + count);
    return *this;
  }
  /// Appends `end`; if both are too long together, truncates the text before it.
  void endWith(const FaultText& end) noexcept {
    size_ = static_cast<unsigned char>(std::min<std::size_t>(size_, kMost - end.size_));
    *this += std::string_view(end.text_.data(), end.size_);
  }
  /// The text, escaped() for people, since it comes from a drive. Not real-time safe.
  std::string text() const;

 private:
  std::array<char, kMost> text_{};
  unsigned char size_ = 0;
};

}  // namespace grinder
