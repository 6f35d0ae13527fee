# For the checks that launch a grinder; to be sourced. Root of the sources, a folder for the check's files, and the roslaunch that
# runs: both go with the check.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(mktemp -d)
launch=

end_launch() {
  [ -z "$launch" ] || { kill -INT "$launch" 2>/dev/null; wait "$launch"; } || true
  launch=
}

# await_grinder COMMAND...: waits until the launched grinder says its state; the command runs what follows it. Where it has ended, or
# after a minute, the check fails with roslaunch's log.
await_grinder() {
  local deadline=$((SECONDS + 60))
  until ("$@" rosrun flute_grinder grind status) </dev/null >/dev/null 2>&1; do
    kill -0 "$launch" && [ $SECONDS -lt $deadline ] || { cat "$folder/log"; exit 1; }
  done
}

cleanup() {
  end_launch
  rm -rf "$folder"
}
trap cleanup EXIT

# use_space SPACE: as a user's shell sources it.
use_space() {
  set +u
  source "$1/setup.bash"
  set -u
}
