#!/usr/bin/env bash
# Every key of package.xml is one that rosdep knows on this system.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

skip() {
  echo "$1"
  exit 77
}
command -v rosdep >/dev/null || skip "rosdep is not installed"
rosdep resolve eigen >/dev/null 2>&1 || skip "rosdep has no rules here; allowed: after 'rosdep update', which needs the network"

rosdep keys --from-paths "$root" | xargs rosdep resolve
