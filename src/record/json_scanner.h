#pragma once

#include "flute_grinder/job/format.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace grinder {

/// Goes through a JSON text once, front to back, and takes from it what is wanted. Several times as fast as a parser,
/// since it only looks for the end of all the rest: what is wrong in there goes unnoticed, but a text that is cut off
/// does not. All functions throw std::invalid_argument for what they do not expect.
class JsonScanner {
 public:
  /// @param text outlives this object.
  explicit JsonScanner(const std::string& text) : at_(text.c_str()), end_(at_ + text.size()) {}

  /// Calls `visit(key)` for every member of the object that follows; what it does not take is skipped. Keys are as in
  /// the text, escapes included.
  template <typename Visit>
  void members(const Visit& visit) {
    list('{', '}', [&] {
      std::string_view key = value();
      if (key.front() != '"') fail();
      expect(':');
      key = key.substr(1, key.size() - 2);
      takeOrSkip([&] { visit(key); });
    });
  }

  /// Calls `visit()` for every element of the array that follows; what it does not take is skipped.
  template <typename Visit>
  void elements(const Visit& visit) {
    list('[', ']', [&] { takeOrSkip(visit); });
  }

  /// The text of the value that follows.
  std::string_view value() {
    skipSpace();
    const char* begin = at_;
    int depth = 0;
    do {
      const char c = peek();
      if (c == '"') {
        skipString();
      } else if (c == '{' || c == '[') {
        ++depth, ++at_;
      } else if (c == '}' || c == ']') {
        --depth, ++at_;
      } else if (depth > 0) {
        ++at_;
      } else {
        while (at_ != end_ && !isEnd(*at_)) ++at_;
      }
    } while (depth > 0);
    if (depth < 0 || at_ == begin) fail();
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  /// The number that follows; nothing for null.
  std::optional<double> number() {
    const std::string_view text = value();
    if (text == "null") return std::nullopt;
    char* end = nullptr;
    const double number = parseNumber(text.data(), &end);
    if (end != text.data() + text.size()) fail();
    return number;
  }

  /// Nothing but space may follow.
  void end() {
    skipSpace();
    if (at_ != end_) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw std::invalid_argument(at_ < end_ ? "not JSON near '" + std::string(at_, std::min(end_, at_ + 20)) + "'"
                                           : "it is cut off");
  }

  static bool isSpace(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
  static bool isEnd(char c) { return isSpace(c) || c == ',' || c == ':' || c == '}' || c == ']'; }

  void skipSpace() {
    while (at_ != end_ && isSpace(*at_)) ++at_;
  }

  char peek() const {
    if (at_ == end_) fail();
    return *at_;
  }

  void skipString() {
    for (++at_; peek() != '"'; ++at_) {
      if (*at_ == '\\') ++at_, peek();
    }
    ++at_;
  }

  bool takes(char c) {
    skipSpace();
    if (peek() != c) return false;
    ++at_;
    return true;
  }

  void expect(char c) {
    if (!takes(c)) fail();
  }

  template <typename Item>
  void list(char open, char close, const Item& item) {
    expect(open);
    if (takes(close)) return;
    do item();
    while (takes(','));
    expect(close);
  }

  template <typename Take>
  void takeOrSkip(const Take& take) {
    const char* before = at_;
    take();
    if (at_ == before) value();
  }

  const char* at_;
  const char* const end_;
};

}  // namespace grinder
