#!/usr/bin/env bash
# Every key of package.xml is one that rosdep knows on this system, by the rules that its user has, or else by those of the network.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
rules=$(mktemp -d)
trap 'rm -rf "$rules"' EXIT

skip() {
  echo "$1"
  exit 77
}
command -v rosdep >/dev/null || skip "rosdep is not installed"
if ! rosdep resolve eigen >/dev/null 2>&1; then
  export ROS_HOME=$rules
  timeout 120 rosdep update >"$rules/log" 2>&1 || skip "rosdep's rules cannot be fetched: $(sed -n '/rror/{s/^\s*//p;q}' "$rules/log")"
fi

rosdep keys --from-paths "$root" | xargs rosdep resolve
