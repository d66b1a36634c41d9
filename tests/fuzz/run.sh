#!/usr/bin/env bash
# Builds the fuzz targets with clang and runs one: tests/fuzz/run.sh [--models] [SECONDS] [libFuzzer's
# options], over scene files, or over models (MJCF, URDF).
# Needs Debian's clang and libclang-rt-14-dev. What it finds stays in build-fuzz/found/.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${DBD_FUZZ_FOLDER:-$root/build-fuzz}
target=fuzz_scene seeds=("$root/scenes/library" "$root/scenes/figures/panels") corpus=$folder/corpus
if [ "${1:-}" = --models ]; then
  shift
  target=fuzz_model seeds=("$root/tests/scenes/models") corpus=$folder/corpus-models
fi
seconds=${1:-600}
shift || true
command -v clang++ > /dev/null || { echo "needs clang++: apt-get install clang libclang-rt-14-dev" >&2; exit 4; }
cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ \
  -DDBD_FUZZ=ON -DDBD_TESTS=OFF -DDBD_BENCHMARKS=OFF > /dev/null
cmake --build "$folder" --target "$target" scene_words
mkdir -p "$corpus" "$folder/found"
"$folder/tests/fuzz/scene_words" > "$folder/words.dict"
# New inputs go to the first folder; what is shipped is the seed.
exec "$folder/tests/fuzz/$target" -max_total_time="$seconds" -dict="$folder/words.dict" -timeout=30 \
  -rss_limit_mb=2048 -malloc_limit_mb=256 -artifact_prefix="$folder/found/" "$@" \
  "$corpus" "${seeds[@]}"
