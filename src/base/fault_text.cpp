#include "flute_grinder/base/fault_text.h"

#include "flute_grinder/base/escaped.h"

namespace grinder {

std::string FaultText::text() const { return escaped({text_.data(), size_}); }

}  // namespace grinder
