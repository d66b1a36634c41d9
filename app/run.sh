#!/usr/bin/env bash
# Installs what is needed, builds dbd, renders the shown scenes into out/ and makes out/index.html.
# Options go to every `dbd render`: ./app/run.sh --quality draft
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/app/prepare.sh"

scenes=(wrecking_ball pyramid heavy_chain ragdoll_stairs ragdoll_drive)

install_packages
build "$root/build" dbd
failed=()
for i in "${!scenes[@]}"; do
  say "Scene $((i + 1)) of ${#scenes[@]}: ${scenes[$i]}"
  code=0
  "$root/build/dbd" render "${scenes[$i]}" --video -o "$root/out/${scenes[$i]}" "$@" || code=$?
  [ "$code" = 130 ] && exit 130
  [ "$code" = 0 ] || failed+=("${scenes[$i]} (exit code $code)")
done
page=$("$root/build/dbd" gallery "$root/out" "${scenes[@]}")
if [ ${#failed[@]} -gt 0 ]; then
  echo "Not rendered: ${failed[*]}" >&2
  echo "$page"
  exit 1
fi
say "Done. Open this page in a browser:"
echo "$page"
