#pragma once

#include <string>

namespace grinder {

/// Gives a file a new text in one step: whoever reads it sees the old text or the new one, also after a power failure.
/// Mode and owner stay; of a symbolic link, the file behind it is replaced.
/// @throw std::system_error if that cannot be done; the file is then as it was, unless it is its folder that cannot be
///        synchronized.
void replaceFile(const std::string& path, const std::string& text);

/// Writes a file in one step in the same way, whether there is one or not; a symbolic link is replaced itself. Returns
/// once the text is on the disk; after a power failure the new file is certain only once settleFile() has returned. One
/// writer at a time: until then the text is in a file of this name and the suffix `.new`, and one that a crash has left
/// is overwritten.
/// @throw std::system_error if that cannot be done; the file is then as it was.
void writeFile(const std::string& path, const std::string& text);

/// Returns once the file's name on the disk stands for the text written last.
/// @throw std::system_error if its folder cannot be synchronized.
void settleFile(const std::string& path);

}  // namespace grinder
