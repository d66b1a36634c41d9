#!/usr/bin/env bash
# Builds the fuzz target with clang and runs it: tests/fuzz/run.sh [SECONDS] [libFuzzer's options].
# Needs Debian's clang and libclang-rt-14-dev. What it finds stays in build-fuzz/found/.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${DBD_FUZZ_FOLDER:-$root/build-fuzz}
seconds=${1:-600}
shift || true
command -v clang++ > /dev/null || { echo "needs clang++: apt-get install clang libclang-rt-14-dev" >&2; exit 4; }
cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ \
  -DDBD_FUZZ=ON -DDBD_TESTS=OFF -DDBD_BENCHMARKS=OFF > /dev/null
cmake --build "$folder" --target fuzz_scene scene_words
mkdir -p "$folder/corpus" "$folder/found"
"$folder/tests/fuzz/scene_words" > "$folder/words.dict"
# New inputs go to the first folder; the library itself is the seed.
exec "$folder/tests/fuzz/fuzz_scene" -max_total_time="$seconds" -dict="$folder/words.dict" -timeout=10 \
  -rss_limit_mb=2048 -malloc_limit_mb=256 -artifact_prefix="$folder/found/" "$@" \
  "$folder/corpus" "$root/scenes/library" "$root/scenes/figures/panels"
