#include "flute_grinder/base/escaped.h"

#include "flute_grinder/base/format.h"

#include <algorithm>
#include <cstddef>

namespace grinder {

namespace {

/// Bytes of a text's first character; 0 if it is not UTF-8.
std::size_t lengthOfCharacter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (first > 0xf4) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
  }
  // An overlong encoding, a surrogate, or beyond the last character.
  const unsigned second = byte(1);
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
  return wrong ? 0 : length;
}

/// Whether a character is a control character of ASCII or Unicode.
bool isControl(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  return first < 0x20 || first == 0x7f || (first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0);
}

std::string escapedByte(char c) {
  switch (c) {
    case '\n': return "\\n";
    case '\r': return "\\r";
    case '\t': return "\\t";
    default: return format("\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
}

}  // namespace

std::string escaped(std::string_view text, std::string_view kept) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = lengthOfCharacter(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    const bool stays = length > 0 && (!isControl(character) || kept.find(character) != std::string_view::npos);
    if (stays) shown += character;
    for (const char c : stays ? std::string_view() : character) shown += escapedByte(c);
    text.remove_prefix(character.size());
  }
  return shown;
}

}  // namespace grinder
