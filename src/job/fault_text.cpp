#include "flute_grinder/job/fault_text.h"

#include "flute_grinder/job/escaped.h"

namespace grinder {

std::string FaultText::text() const { return escaped({text_.data(), size_}); }

}  // namespace grinder
