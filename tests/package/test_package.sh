#!/usr/bin/env bash
# test_package.sh BUILD FOLDER: installs BUILD into FOLDER, and has a project outside use it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1 folder=$2
rm -rf "$folder"
cmake --install "$build" --prefix "$folder/installed" > /dev/null
# The program finds its scenes where it stands, wherever that is.
mv "$folder/installed" "$folder/moved"
(cd / && env -u DBD_HOME "$folder/moved/bin/dbd" doctor) | tee "$folder/doctor.txt"
grep -q "$folder/moved/.*share/dbd/scenes/library" "$folder/doctor.txt"
(cd "$folder" && env -u DBD_HOME moved/bin/dbd render pendulum --frames 0 --size 160x90 --quality draft \
  --progress none --quiet -o drawn)
test -s "$folder/drawn/frames/00000.png"
cmake -S "$here" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/moved" -DCMAKE_BUILD_TYPE=Release > /dev/null
cmake --build "$folder/build"
cd "$folder/build" && ./outside
test -s frame.png
