#!/usr/bin/env bash
# The state hash of every scene of the library, from g++ and clang++ where they are installed, at -O1
# and -O3, with and without sanitizers: they must be the same. tests/hashes/run.sh [FRAMES]
# Each variant is built in build-hashes/; clang is optional (Debian: clang libclang-rt-14-dev).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${DBD_HASHES_FOLDER:-$root/build-hashes}
frames=${1:-30}
mkdir -p "$folder"

# variant NAME COMPILER FLAGS SANITIZE
variant() {
  command -v "$2" > /dev/null || { echo "$1: no $2 here, left out"; return 0; }
  cmake -S "$root" -B "$folder/$1" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$2" \
    -DCMAKE_CXX_FLAGS="$3" -DSANITIZE="$4" -DDBD_BENCHMARKS=OFF > "$folder/$1.log" 2>&1 ||
    { cat "$folder/$1.log" >&2; exit 1; }
  cmake --build "$folder/$1" --target state_hashes > "$folder/$1.log" 2>&1 ||
    { tail -40 "$folder/$1.log" >&2; exit 1; }
  ASAN_OPTIONS=detect_leaks=0 "$folder/$1/tests/hashes/state_hashes" "$frames" > "$folder/$1.txt"
  # The C library's functions by processor: nothing of their last bits may reach the state.
  GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable,-FMA4 \
    ASAN_OPTIONS=detect_leaks=0 "$folder/$1/tests/hashes/state_hashes" "$frames" \
    > "$folder/$1-plain-libm.txt"
  made+=("$1" "$1-plain-libm")
}

made=()
for compiler in g++ clang++; do
  variant "$compiler-O3" "$compiler" "-O3 -DNDEBUG" OFF
  variant "$compiler-O1" "$compiler" "-O1 -DNDEBUG" OFF
  variant "$compiler-sanitized" "$compiler" "-O3 -DNDEBUG" ON  # as tests/run.sh --sanitize
done

failed=0
for name in "${made[@]}"; do
  if difference=$(diff "$folder/${made[0]}.txt" "$folder/$name.txt"); then
    echo "$name: $(wc -l < "$folder/$name.txt") scenes, the same as ${made[0]}"
  else
    failed=1
    echo "$name: differs from ${made[0]}:"
    echo "$difference"
  fi
done
exit $failed
