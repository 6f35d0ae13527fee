#pragma once

#include "flute_grinder/ConfirmWheel.h"
#include "flute_grinder/JogStep.h"
#include "flute_grinder/Reclamped.h"
#include "flute_grinder/SetOffsets.h"
#include "flute_grinder/TouchOff.h"
#include "flute_grinder/motion/work_offsets.h"

#include <string>
#include <vector>

/// @file
/// Requests to the grinder's services, in the name of this user.
namespace grinder {

/// @param values the work offsets. @param basis job and wheel for which they are set.
/// @param answers answers to needs of an earlier response, see NeedAnswer.msg.
flute_grinder::SetOffsets::Request offsetsRequest(const OffsetValues& values, const OffsetBasis& basis,
                                                  const std::vector<std::string>& answers);
/// @param position work position of the place where the axis is [m], A [rad].
flute_grinder::TouchOff::Request touchOffRequest(int axis, double position, const OffsetBasis& basis,
                                                 const std::vector<std::string>& answers);
/// @param job whose wheel is on the spindle. @param again whether it was taken off and mounted anew.
flute_grinder::ConfirmWheel::Request wheelRequest(const OffsetBasis& job, bool again);
flute_grinder::Reclamped::Request reclampedRequest();
/// @param distance signed [m], A [rad]. @param speed [m/s], A [rad/s]; 0: the machine's jog_velocity.
flute_grinder::JogStep::Request jogRequest(int axis, double distance, double speed);

}  // namespace grinder
