#!/usr/bin/env bash
# Installs what is needed, builds everything and runs every test.
#   ./tests/run.sh                     as it ships, in build/
#   ./tests/run.sh --sanitize          the same under the address and undefined behaviour sanitizers,
#                                      of the hard cases the quick ones; and what runs on several
#                                      threads under the thread sanitizer
# Other options go to CTest: ./tests/run.sh -R Golden
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/app/prepare.sh"

folder=$root/build
options=()
sanitize=
if [ "${1:-}" = --sanitize ]; then
  shift
  sanitize=yes
  folder=$root/build-sanitize
  options+=(-DSANITIZE=ON -DDBD_BENCHMARKS=OFF)
  export CXX=${CXX:-g++}  # its sanitizers come with it
  # Mesa and fontconfig keep what they allocate; overlapping scopes of the stack are looked at too.
  export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0:detect_stack_use_after_return=1}
  export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
fi

install_packages
if [ -n "$sanitize" ]; then
  build "$folder-threads" test_threads -- -DSANITIZE=thread -DDBD_BENCHMARKS=OFF
  say "Testing threads"
  "$folder-threads/tests/app/test_threads"
fi
build "$folder" all -- ${options[@]+"${options[@]}"}
if [ -n "$sanitize" ] && [ $# = 0 ]; then
  say "Testing hard cases"
  "$folder/dbd" study stability --quick --fresh --quiet -o "$folder/stability_quick"
  set -- -LE stability
fi
say "Testing"
cd "$folder"
ctest --output-on-failure -j "$(nproc)" "$@" < /dev/null
