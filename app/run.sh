#!/usr/bin/env bash
# Installs what is needed, builds dbd, renders the shown scenes into out/scenes, makes the paper's
# figures in out/, measures what accuracy costs into out/study and what effects cost into
# out/study_effects, and runs hard cases into out/stability. out/index.html has what is done so far.
# Options go to every `dbd render` and to `dbd figures`: ./app/run.sh --quality draft
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/app/prepare.sh"

scenes=(wrecking_ball pyramid heavy_chain ragdoll_stairs ragdoll_drive)
failed=()

# run WHAT ARGUMENT...: dbd with these; a failure is remembered, an interruption ends all.
run() {
  local what=$1 code=0
  shift
  "$root/build/dbd" "$@" || code=$?
  [ "$code" = 130 ] && exit 130
  [ "$code" = 0 ] || failed+=("$what (exit code $code)")
}

# render SCENE ARGUMENT...: out/ is this script's own, so frames of an earlier program or of other
# options make way.
render() {
  local scene=$1 code=0
  shift
  local command=(render "$scene" --video -o "$root/out/scenes/$scene" "$@")
  "$root/build/dbd" "${command[@]}" || code=$?
  [ "$code" = 130 ] && exit 130
  [ "$code" = 2 ] && { run "$scene" "${command[@]}" --fresh; return; }
  [ "$code" = 0 ] || failed+=("$scene (exit code $code)")
}

# The page of what there is.
show() { "$root/build/dbd" gallery "$root/out" > /dev/null || true; }

install_packages
build "$root/build" dbd
for i in "${!scenes[@]}"; do
  say "Scene $((i + 1)) of ${#scenes[@]}: ${scenes[$i]}"
  render "${scenes[$i]}" "$@"
  show
  if [ "$i" = 0 ]; then
    say "A first film: $root/out/scenes/${scenes[0]}/${scenes[0]}.mp4"
    echo "   What is done so far: $root/out/index.html (a reload shows more)"
  fi
done
say "Figures"
run figures figures -o "$root/out" "$@"
say "What accuracy costs in time: the quick study"
run "accuracy study" study accuracy --quick -o "$root/out/study"
show
say "What each effect costs: the quick study"
run "effects study" study effects --quick -o "$root/out/study_effects"
show
say "Hard cases: the quick ones"
run "stability study" study stability --quick -o "$root/out/stability"
show
if [ ${#failed[@]} -gt 0 ]; then
  echo "Not as it should be: ${failed[*]}" >&2
  echo "$root/out/index.html"
  exit 1
fi
say "Done. Open this page in a browser:"
echo "$root/out/index.html"
