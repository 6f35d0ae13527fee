#pragma once

#include "flute_grinder/messages/json.h"

#include <string>

namespace grinder {

/// What readRecordSummary() returns, of the text of a record. @throw std::exception if it is none.
Json summaryOf(const std::string& text);

}  // namespace grinder
