# shellcheck shell=bash disable=SC2154
# Sourced by app/run.sh and tests/run.sh: installs the packages of app/packages.txt, configures, builds.
# Expects `root`, the folder of the source tree.

say() { printf '\n== %s\n' "$*"; }

missing_packages() {
  local package
  while read -r package; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done < "$root/app/packages.txt"
}

install_packages() {
  local missing as_root=()
  missing=$(missing_packages | tr '\n' ' ')
  [ -n "$missing" ] || return 0
  say "Installing: $missing"
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These packages are needed, and there is neither root nor sudo here. As root, run:" >&2
      echo "  apt-get update && apt-get install -y --no-install-recommends $missing" >&2
      exit 4
    fi
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -q
  # shellcheck disable=SC2086  # a list of words
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends $missing
}

# build FOLDER TARGET... -- CMAKE_ARGUMENT...
build() {
  local folder=$1 targets=()
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do targets+=("$1"); shift; done
  [ $# -gt 0 ] && shift
  say "Building in $folder"
  # clang++ where nothing else is said: the same bytes as g++ in three quarters of the time. A folder
  # that is there keeps its compiler.
  [ -f "$folder/CMakeCache.txt" ] || set -- -DCMAKE_CXX_COMPILER="${CXX:-clang++}" "$@"
  cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" > "$folder.log" 2>&1 ||
    { cat "$folder.log" >&2; exit 1; }
  rm -f "$folder.log"
  cmake --build "$folder" --target "${targets[@]}"
}
