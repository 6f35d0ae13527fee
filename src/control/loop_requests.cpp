#include "flute_grinder/control/loop_requests.h"

#include <sstream>

namespace flute_grinder {

RequestReply Answer::reply() const {
  if (refusal == Refusal::kNone) return {true, "", true};
  std::ostringstream text;
  text << toString(event) << " refused: ";
  switch (refusal) {
    case Refusal::kNone: break;
    case Refusal::kState:
      text << "the machine is in state " << toString(state) << "; allowed: " << allowedIn(state);
      break;
    case Refusal::kEmergencyStop: text << "the emergency stop is pressed; release it first"; break;
    case Refusal::kDriveFault: text << "the drive reports a fault; reset it first"; break;
    case Refusal::kInterlock: text << toString(interlock); break;
    case Refusal::kNoPower: text << "the drive did not switch its power on in time"; break;
    case Refusal::kMoved: text << "the axes do not stand where the job was planned to start; plan it again"; break;
    case Refusal::kFeedback: text << "the drive gives no valid, fresh positions"; break;
    case Refusal::kWithdrawn: text << "disable came before the power"; break;
    case Refusal::kInWork: text << "the wheel stands in the work; lift it first"; break;
    case Refusal::kNotInWork: text << "the wheel does not stand in the work"; break;
    case Refusal::kLiftTooFar:
      // In shop units, because only people read it: the answer to a request has no fields for data.
      text << "it would lead " << axisName(kY, UnitSystem::kShop) << " to "
           << flute_grinder::text({value, Unit::kMetre}, UnitSystem::kShop) << "; allowed: up to "
           << flute_grinder::text({limit, Unit::kMetre}, UnitSystem::kShop);
      break;
  }
  return {false, text.str(), true};
}

}  // namespace flute_grinder
