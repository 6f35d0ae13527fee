#pragma once

#include <string>
#include <vector>

namespace grinder {

/// The known word that is nearest to an unknown one, for the end of a message: "; did you mean 'hold'?". A word that
/// was begun is near; otherwise two letters at most may differ. @return empty if none is near.
std::string didYouMean(const std::string& word, const std::vector<std::string>& known);

}  // namespace grinder
