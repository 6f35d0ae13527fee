#pragma once

#include <string>

namespace flute_grinder {

/// Gives a file a new text in one step: whoever reads it sees the old text or the new one, also after a power failure.
/// Mode and owner stay; of a symbolic link, the file behind it is replaced.
/// @throw std::system_error if that cannot be done; the file is then as it was, unless it is its folder that cannot be
///        synchronized.
void replaceFile(const std::string& path, const std::string& text);

/// Writes a file in one step in the same way, whether there is one or not. It can be read by all; a symbolic link is
/// replaced itself. Until then the text is in a file of this name and a suffix of a dot and six characters.
/// @throw std::system_error as replaceFile().
void writeFile(const std::string& path, const std::string& text);

}  // namespace flute_grinder
