#pragma once

#include "flute_grinder/messages/json.h"

namespace grinder {

/// Refuses a record of which a key is missing or has a value of another type than JobRecord writes, and escapes its
/// texts. @param record as readRecord() or readRecordSummary() returns it. @param summary whether it is of the latter.
/// @throw std::invalid_argument naming key, value and what is allowed.
void checkRecord(Json& record, bool summary);

}  // namespace grinder
