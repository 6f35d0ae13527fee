#pragma once

#include <ros/time.h>

namespace grinder {

/// The age of a message by a peer's stamp and the system clock [s]; negative if the peer's clock is ahead. Computed in
/// seconds, because a difference of stamps throws if ros::Duration cannot hold it.
inline double ageOf(const ros::Time& stamp) { return ros::Time::now().toSec() - stamp.toSec(); }

}  // namespace grinder
