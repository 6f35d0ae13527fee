#pragma once

#include <string>
#include <string_view>

namespace grinder {

/// Text as by std::printf, of any length, with a decimal point in any locale.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

/// A number with some decimals; one that rounds to zero has no sign.
std::string fixed(double value, int decimals);

/// The number at the start of a text, as by std::strtod, with a decimal point in any locale.
/// @param end end of the number; the start of the text if there is no number.
double parseNumber(const char* text, char** end = nullptr);

inline bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

/// Whether a text has the form of a pattern in which 0 stands for any digit, e.g. "0000-00-00".
bool hasForm(std::string_view text, std::string_view form);

}  // namespace grinder
