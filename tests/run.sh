#!/usr/bin/env bash
# Installs what is needed, builds everything and runs every test.
#   ./tests/run.sh                     as it ships, in build/
#   ./tests/run.sh --sanitize          the same under the address and undefined behaviour sanitizers
# Other options go to CTest: ./tests/run.sh -R Golden
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/app/prepare.sh"

folder=$root/build
options=()
if [ "${1:-}" = --sanitize ]; then
  shift
  folder=$root/build-sanitize
  options+=(-DSANITIZE=ON -DDBD_BENCHMARKS=OFF)
fi

install_packages
build "$folder" all -- ${options[@]+"${options[@]}"}
say "Testing"
cd "$folder"
ctest --output-on-failure -j "$(nproc)" "$@" < /dev/null
