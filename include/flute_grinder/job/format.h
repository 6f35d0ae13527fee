#pragma once

#include <string>
#include <string_view>

namespace grinder {

struct CutterGeometry;

/// Text as by std::printf, of any length, and in any locale with a point in its numbers.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

/// The number that a text begins with, as by std::strtod, in any locale with a point.
/// @param end where it ends; the text's beginning if there is none.
double parseNumber(const char* text, char** end = nullptr);

/// Whether a text has the form of another, in which 0 stands for any digit, e.g. "0000-00-00".
bool hasForm(std::string_view text, std::string_view form);

/// The tool in words for people, in shop units, e.g. "D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth".
std::string toolText(const CutterGeometry& cutter, std::size_t teeth);

/// A job with its tool, for people. @param name of its file; may be empty. @param operation as
/// GrindJob::operationText().
std::string jobText(const std::string& name, const std::string& operation, const CutterGeometry& cutter,
                    std::size_t teeth);

}  // namespace grinder
