#!/usr/bin/env bash
# The package in a catkin workspace, beside a package that uses its messages and libraries (test/workspace/neighbour) and the drive
# plugin of docs/drive-plugin.md: tests, programs and launch files from the devel space and from the install space.
# Nothing is optimised there, and all sources of a module are compiled as one, which takes half the time; the panel is left out.
set -euo pipefail
source "$(dirname "$0")/launched.sh"
# Kept: the first run compiles the whole package, those after it only what has changed. Not below the clone, where roslaunch would
# find every file twice.
workspace=${XDG_CACHE_HOME:-$HOME/.cache}/flute_grinder$root

# Nothing of the clone's own build.
unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_ETC_DIR PYTHONPATH LD_LIBRARY_PATH PKG_CONFIG_PATH
for ros in /opt/ros/*; do
  [ ! -f "$ros/setup.bash" ] || use_space "$ros"
done

# The files keep their times, by which make goes.
rm -rf "$workspace"/src/{flute_grinder,neighbour}
mkdir -p "$workspace/src/flute_grinder"
find "$root" -mindepth 1 -maxdepth 1 ! -name build ! -name '.*' -exec cp -a -t "$workspace/src/flute_grinder" {} +
cp -a "$root/test/workspace/neighbour" "$workspace/src"
/usr/bin/python3 "$root/test/docs/pages.py" "$root/docs/drive-plugin.md" "$workspace/src"
{ sed 's#flute_grinder/SimulatedDrive#my_drive/MyDrive#; /^late_cycle:/d' "$root/config/grinder.yaml"
  cat "$root/test/patient.yaml"; } >"$folder/machine.yaml"

# Where CLI11 is no package, it is fetched once for both.
cli11=$(sed -n 's/^CLI11_SOURCE_DIR:STATIC=//p' "$root/build/CMakeCache.txt")

# make_workspace TARGET...
make_workspace() {
  local begin=$SECONDS
  (cd "$workspace" && catkin_make --no-color -j"$(nproc)" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
    -DBUILD_BENCHMARKS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_rviz=ON ${cli11:+-DFETCHCONTENT_SOURCE_DIR_CLI11="$cli11"} \
    -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=--param=ggc-min-heapsize=1000000 \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 "$@") >"$folder/log" 2>&1 || { tail -n 40 "$folder/log"; exit 1; }
  echo "catkin_make $*: $((SECONDS - begin)) s"
}

# The tests first: they depend on all that they need, in a workspace that has nothing yet.
rm -rf "$workspace/build/test_results"
make_workspace run_tests_flute_grinder_gtest_flute_grinder_test_drive_clock run_tests_flute_grinder_roslaunch-check \
  run_tests_flute_grinder_rostest_test_node_stand_in.test
catkin_test_results "$workspace/build/test_results"
make_workspace
[ ! -e "$workspace/build/devel" ]
make_workspace install

# check_space SPACE SHARE: in the shell of a user who has sourced it.
check_space() (
  # The workspace's other robots stay where they are.
  unset ROS_IP ROS_HOSTNAME
  use_space "$1"
  [ -z "${ROS_IP:-}${ROS_HOSTNAME:-}" ]
  [[ ${ROS_ETC_DIR:-} != *flute_grinder* ]]
  [ "$(rospack find flute_grinder)" = "$2" ]
  rosrun flute_grinder grind table "$2/jobs/paper.yaml" --step-length 0.2 </dev/null | grep -q '^152 points'
  roslaunch -p "${ROS_MASTER_URI##*:}" flute_grinder grinder.launch config:="$folder/machine.yaml" \
    journal:="$folder/journal" >"$folder/log" 2>&1 &
  launch=$!
  trap end_launch EXIT
  await_grinder env
  rosrun flute_grinder grind enable </dev/null
  ps -o args= --ppid "$launch" | grep -q "^$1/lib/flute_grinder/grinder "
  # Without an address or without parameters it does not start, and says so.
  { ! rosrun flute_grinder grinder __name:=second </dev/null 2>&1; } | grep -q 'neither ROS_HOSTNAME nor ROS_IP is set'
  { ! ROS_IP=127.0.0.1 rosrun flute_grinder grinder __name:=second </dev/null 2>&1; } | grep -q 'parameter /second/'
  rosrun neighbour grinder "$2/jobs/paper.yaml" </dev/null | tee "$folder/state"
  grep -q '^ready; axis_0 .*; A(1 m) = 2 rad; Y of the first setpoint = 0.05 m$' "$folder/state"
)
for space in devel install; do
  share=$workspace/src/flute_grinder
  [ "$space" = devel ] || share=$workspace/install/share/flute_grinder
  echo "$space space:"
  check_space "$workspace/$space" "$share"
done
