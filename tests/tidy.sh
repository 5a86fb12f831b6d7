#!/usr/bin/env bash
# clang-tidy over every translation unit of BUILD, as many at a time as there are processors.
set -euo pipefail
build=$1
cd "$(dirname "$0")/.."
git ls-files '*.cpp' | grep -v '^bench/peer/' | while read -r file; do
  grep -qF "\"$PWD/$file\"" "$build/compile_commands.json" && echo "$file"
done | xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p "$build" 2> >(grep -vE 'warnings? (generated|treated)|^Suppressed|^Use -header-filter' >&2)
