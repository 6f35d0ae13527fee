#include "flute_grinder/machine/loop_fault.h"

namespace grinder {

std::string LoopFault::text() const { return grinder::text(reasonOf(*this)); }

Reason reasonOf(const LoopFault& fault) {
  if (fault.kind == FaultKind::kLimit) return reasonOf(fault.violation);
  const FaultRow& row = rowOf(fault.kind);
  Reason reason;
  reason.kind = row.reason;
  reason.axis = fault.axis;
  reason.detail = toString(fault.interlock);
  const std::string words = fault.drive_text.text();
  if (!words.empty()) reason.detail = ": " + words;
  reason.unit = row.unit == Unit::kMetre ? unitOf(fault.axis, 0) : row.unit;
  reason.value = fault.value;
  reason.limit = fault.limit;
  reason.cycle = fault.cycle;
  return reason;
}

}  // namespace grinder
