#pragma once

#include <string>
#include <vector>

namespace grinder {

/// The known word nearest to an unknown one, as the end of a message: "; did you mean 'hold'?". A known word is near if
/// it begins with the unknown one, or differs in at most two letters.
/// @return empty if no word is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& known);

}  // namespace grinder
