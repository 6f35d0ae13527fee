#pragma once

#include <actionlib_msgs/GoalID.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <memory>

namespace ros::serialization {

/// The serializer of a goal's id or of a cancel. A stamp more than a minute ahead of the system clock is read as the
/// present time: actionlib adds a timeout to it, which throws near the end of ros::Time's range, and a cancel stamped
/// in the future would cancel all goals until then. Otherwise identical to the generated serializer. Every file that
/// reads or writes messages must see it: CMakeLists.txt includes it in all files of the node.
template <>
struct Serializer<actionlib_msgs::GoalID_<std::allocator<void>>> {
  using GoalID = actionlib_msgs::GoalID_<std::allocator<void>>;

  template <typename Stream>
  static void write(Stream& stream, const GoalID& id) {
    stream.next(id.stamp);
    stream.next(id.id);
  }

  template <typename Stream>
  static void read(Stream& stream, GoalID& id) {
    constexpr double ahead = 60;  // longest time ahead of the clock [s]
    stream.next(id.stamp);
    stream.next(id.id);
    const WallTime now = WallTime::now();
    if (!(id.stamp.toSec() <= now.toSec() + ahead)) id.stamp = Time(now.sec, now.nsec);
  }

  static std::uint32_t serializedLength(const GoalID& id) {
    return serializationLength(id.stamp) + serializationLength(id.id);
  }
};

}  // namespace ros::serialization
