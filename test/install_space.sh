#!/usr/bin/env bash
# The installed package works without the source and the build: programs, launch file, plugin.
set -euo pipefail
source "$(dirname "$0")/launched.sh"

# catkin's set-up files would not follow. CMake breaks the lines of what it says.
{ ! cmake --install "$root/build" --prefix "$folder/other" 2>&1; } | tr -s '\n ' ' ' | grep -q " prefix = $folder/other; allowed: "
[ ! -e "$folder/other" ]

DESTDIR=$folder cmake --install "$root/build" >/dev/null
space=$folder$(sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$root/build/CMakeCache.txt")
cd "$space"
unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH PYTHONPATH LD_LIBRARY_PATH
use_space "$space"
[ "$(rospack find flute_grinder)" = "$space/share/flute_grinder" ]
for file in urdf/grinder.urdf rviz/grinder.rviz config/grinder.yaml drive_plugins.xml rviz_plugins.xml \
  monitoring/prometheus.yml monitoring/alerts.yml; do
  [ -f "share/flute_grinder/$file" ]
done

# What streams a flute, and plans a job, in a package without catkin. The curve brings neither ROS nor OpenSSL.
{ cmake -S "$root/examples/plain" -B "$folder/plain" && cmake --build "$folder/plain"; } >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
"$folder/plain/stream_a_flute" | grep -q '^3502,0.030000000,'
[ -z "$(grep -E 'roscpp|libcrypto|libyaml' "$folder/plain/CMakeFiles/stream_a_flute.dir/link.txt")" ]
grep -q libcrypto "$folder/plain/CMakeFiles/stream_a_job.dir/link.txt"
(cd share/flute_grinder && "$folder/plain/stream_a_job") | grep -q '^planned: 8587 setpoints$'

# What a drive plugin includes, and not the drives' own headers.
[ -f include/flute_grinder/drive/drive.h ]
[ -z "$(ls include/flute_grinder/drive | grep -E 'hal_|simulated_drive')" ]

port=$("$root/test/free_port.py")
export ROS_MASTER_URI=http://127.0.0.1:$port
# For a host that stalls, as test/patient.yaml.
sed 's/^late_cycle: .*/late_cycle: {slow_down: 1.0e+6, fault: 1.0e+6}/' share/flute_grinder/config/grinder.yaml >"$folder/patient.yaml"
grep -q 'fault: 1.0e+6' "$folder/patient.yaml"
roslaunch -p "$port" flute_grinder grinder.launch journal:="$folder/journal" config:="$folder/patient.yaml" >"$folder/log" 2>&1 &
launch=$!
job=share/flute_grinder/jobs/paper.yaml
rosrun flute_grinder grind plan "$job" | grep -q '^setpoints'
# A job that names its wheel by a file.
rosrun flute_grinder grind table share/flute_grinder/jobs/unequal_d12_t4.yaml --step-length 1 >/dev/null
# A client in Python, which has the goal from the program beside it.
/usr/bin/python3 -c 'import sys; from flute_grinder import job; print(job.goal(sys.argv[1]).job_name, job.__file__)' "$job" |
  grep -q "^paper.yaml $space/lib/"
rosrun flute_grinder exporter --help | grep -q -e '--listen ADDRESS:PORT'
await_grinder env
rosrun flute_grinder grind enable
rosrun flute_grinder grind run "$job" --dry-run
rosrun flute_grinder grind confirm-swivel 32.34
rosrun flute_grinder grind run "$job" --answer ignore-offsets
rosrun flute_grinder grind report --last --from "$folder/journal.history/grinder" -o "$folder/report.html"
grep -q 'own measurement decides' "$folder/report.html"
# It does not start without parameters.
{ ! rosrun flute_grinder grinder __name:=second 2>&1; } | grep -q 'parameter /second/'
