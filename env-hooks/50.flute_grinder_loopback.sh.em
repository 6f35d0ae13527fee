# ROS stays on this computer unless the shell says otherwise: a launch file comes too late for the master.
if [ -z "${ROS_IP:-}" ] && [ -z "${ROS_HOSTNAME:-}" ]; then
  export ROS_IP=127.0.0.1
fi
# What is started with a master, unless somebody has a folder of their own for that.
case "${ROS_ETC_DIR:-}" in
  "" | /etc/ros | //etc/ros)
@[if DEVELSPACE]@
    export ROS_ETC_DIR="@(CMAKE_CURRENT_SOURCE_DIR)/ros"
@[else]@
    export ROS_ETC_DIR="$CATKIN_ENV_HOOK_WORKSPACE/share/flute_grinder/ros"
@[end if]@
    ;;
esac
