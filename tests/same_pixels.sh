#!/usr/bin/env bash
# The same pixels from every build: usage same_pixels.sh BUILD BUILD...
# Draws a list of small frames with each build and compares the hashes that `limn render --hash` prints.
set -euo pipefail
shopt -s inherit_errexit
cd "$(dirname "$0")/.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

hashes() {
  local limn=$1/apps/limn model method
  local out=(-o "$scratch/%d.rgba" --format rgba --hash --quiet)
  for model in demo sphere-200 torus-576 knot-480 cone-70 pawn; do
    for method in flat patches curves pn; do
      echo "$model $method"
      "$limn" render "builtin:$model" --method "$method" --size 200x150 --turntable 3 "${out[@]}"
    done
  done
  echo "large, orthographic, 8 samples"
  "$limn" render builtin:icosphere:5 --ortho 2.5 --samples 8 --size 333x257 "${out[@]}"
}

first=$1
expected=$(hashes "$first")
for build in "${@:2}"; do
  if ! diff <(echo "$expected") <(hashes "$build") >/dev/null; then
    echo "limn: $build draws other pixels than $first:" >&2
    diff <(echo "$expected") <(hashes "$build") >&2 || true
    exit 1
  fi
done
echo "limn: the same pixels from $*"
