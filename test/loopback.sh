#!/usr/bin/env bash
# What another computer reaches, seen from a second network namespace: nothing of what README launches, by IPv4 and by
# IPv6; with loopback_only:=false the same look finds the master and the nodes, as docs/network.md says.
set -euo pipefail
source "$(dirname "$0")/launched.sh"

space=grinder_peer_$$
own=10.213.7.1
own6=fd9e:213:7::1
cut_link() {
  ip netns delete "$space" 2>/dev/null || true
  ip link delete "veth_$$" 2>/dev/null || true
}
trap 'cleanup; cut_link' EXIT

if ! ip netns add "$space" 2>"$folder/refusal"; then
  echo "no network namespace may be made here ($(cat "$folder/refusal"))"
  exit 77
fi
ip link add "veth_$$" type veth peer name outside netns "$space"
ip address add "$own/24" dev "veth_$$"
ip -6 address add "$own6/64" dev "veth_$$" nodad
ip link set "veth_$$" up
ip -n "$space" address add 10.213.7.2/24 dev outside
ip -n "$space" -6 address add fd9e:213:7::2/64 dev outside nodad
ip -n "$space" link set outside up

unset ROS_HOSTNAME ROS_IP ROS_ETC_DIR
use_space "$root/build/devel"

# with_hosts COMMAND...: becomes a command for which localhost is ::1 too, as on most computers.
printf '127.0.0.1 localhost\n::1 localhost\n' >"$folder/hosts"
export folder
with_hosts() {
  exec unshare --mount bash -c 'mount --bind "$folder/hosts" /etc/hosts && exec "$@"' - "$@"
}

# ports: those that this test's processes listen on, one a line. Others may have some of their own here.
ports() {
  local group
  group=$(ps -o pid= --ppid "$launch" | tr -d ' ' | tr '\n' ' ')
  for pid in "$launch" $group; do ss -Hltnp | grep "pid=$pid," || true; done | awk '{print $4}' | sed 's/.*://' | sort -nu
}

# reached: the ports that are reached from the other namespace.
reached() {
  ip netns exec "$space" /usr/bin/python3 - "$own" "$own6" $(ports) <<'PYTHON'
import socket, sys
for port in map(int, sys.argv[3:]):
    for address in sys.argv[1:3]:
        try:
            socket.create_connection((address, port), timeout=5).close()
        except OSError:
            continue
        print(port, address)
PYTHON
}

# launch_grinder VARIABLE=VALUE... -- ARGUMENT...: starts the README's launch, and waits until the grinder says its state.
launch_grinder() {
  local variables=()
  while [ "$1" != -- ]; do variables+=("$1"); shift; done
  shift
  local port
  port=$("$root/test/free_port.py")
  local address=127.0.0.1
  [[ " ${variables[*]} " == *ROS_IPV6=on* ]] && address=localhost
  [[ " ${variables[*]} " == *"ROS_IP=$own"* ]] && address=$own
  export ROS_MASTER_URI=http://$address:$port
  with_hosts env "${variables[@]}" roslaunch -p "$port" flute_grinder grinder.launch bag:=true bag_file:="$folder/$port.bag" \
    journal:="$folder/journal" "$@" >"$folder/log" 2>&1 &
  launch=$!
  await_grinder with_hosts env "${variables[@]}"
  # The master, roslaunch itself, the log's collector, the grinder, its joint states' publisher, the recorder.
  [ "$(ports | wc -l)" -ge 9 ] || { echo "listening only on $(ports | tr '\n' ' ')"; exit 1; }
}

# nothing_reached CASE
nothing_reached() {
  local open
  open=$(reached)
  [ -z "$open" ] || { echo "$1: reached from another computer: $open"; ss -Hltnp; exit 1; }
  echo "$1: nothing is reached of $(ports | wc -l) ports"
}

# refused ADDRESS ARGUMENT...: launching says no where the shell's address, ROS_HOSTNAME's if that is set, and the argument
# are not of one mind.
refused() {
  local answer
  answer=$(ROS_IP=$1 roslaunch --nodes flute_grinder grinder.launch "${@:2}" 2>&1) &&
    { echo "launched with ROS_IP=$1 ${*:2}"; exit 1; }
  grep -q "the address in ROS_HOSTNAME or ROS_IP is '${ROS_HOSTNAME-$1}'; allowed: " <<<"$answer" || { echo "$answer"; exit 1; }
}

refused "$own"
refused 127.0.0.1 loopback_only:=false
refused '' loopback_only:=true
ROS_HOSTNAME='' refused 127.0.0.1
for every in 0.0.0.0 ::; do refused "$every" loopback_only:=false; done

launch_grinder --
nothing_reached 'as README says'
end_launch
launch_grinder ROS_IPV6=on ROS_HOSTNAME=localhost --
nothing_reached 'with ROS_IPV6=on'
end_launch
launch_grinder "ROS_IP=$own" -- loopback_only:=false
open=$(reached | wc -l)
[ "$open" -ge 9 ] || { echo "loopback_only:=false: only $open ports are reached"; exit 1; }
echo "loopback_only:=false: $open ports are reached"
