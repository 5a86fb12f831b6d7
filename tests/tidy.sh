#!/usr/bin/env bash
# clang-tidy with as many processes as processors: usage tidy.sh BUILD [all]
# Without `all`: the checks that read one expression at a time, on all but tests; the path-sensitive analyzer doubles the
# time and, like the tests' own sources, has its turn in `make check-all`.
set -euo pipefail
build=$1
cd "$(dirname "$0")/.."
if [ "${2:-}" = all ]; then
  folders=(raster silhouette apps bench tests)
  checks=()
else
  folders=(raster silhouette apps bench)
  checks=(--checks=-clang-analyzer-*)
fi
git ls-files -- "${folders[@]/%//*.cpp}" | while read -r file; do
  if grep -qF "\"$PWD/$file\"" "$build/compile_commands.json"; then echo "$file"; fi
done | xargs -P "$(nproc)" -n 1 clang-tidy --quiet "${checks[@]}" -p "$build" 2> >(grep -vE 'warnings? (generated|treated)|^Suppressed|^Use -header-filter' >&2)
