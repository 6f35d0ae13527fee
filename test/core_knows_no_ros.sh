#!/usr/bin/env bash
# Core stands on the standard library, Eigen and yaml-cpp alone.
cd "$(dirname "$0")/.."
foreign=$(grep -rnE '^#include' include/flute_grinder/core src/core |
  grep -vE '#include (<[a-z_]+>|<Eigen/|<yaml-cpp/|"flute_grinder/core/)')
[ -z "$foreign" ] || { echo "$foreign"; exit 1; }
