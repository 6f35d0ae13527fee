# An empty name would count, and all addresses with it.
[ -n "${ROS_HOSTNAME:-}" ] || unset ROS_HOSTNAME
# Keeps ROS on this computer, unless the shell says otherwise; a launch file would be too late for the master.
if [ -z "${ROS_IP:-}" ] && [ -z "${ROS_HOSTNAME:-}" ]; then
  export ROS_IP=127.0.0.1
fi
# What roslaunch starts together with a master, unless the user has set another folder.
case "${ROS_ETC_DIR:-}" in
  "" | /etc/ros | //etc/ros)
@[if DEVELSPACE]@
    export ROS_ETC_DIR="@(CMAKE_CURRENT_SOURCE_DIR)/ros"
@[else]@
    export ROS_ETC_DIR="$CATKIN_ENV_HOOK_WORKSPACE/share/flute_grinder/ros"
@[end if]@
    ;;
esac
