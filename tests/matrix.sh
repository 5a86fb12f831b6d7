#!/usr/bin/env bash
# The long matrix of `make check-all`: compilers × optimisation levels must draw the same pixels and pass the tests.
set -euo pipefail
cd "$(dirname "$0")/.."

builds=(build/release build/clang)
for compiler in g++ clang++ clang++-19; do
  command -v "$compiler" >/dev/null || continue
  for level in 0 2 3; do
    build=build/matrix/$compiler-O$level
    cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Matrix \
      -DCMAKE_CXX_FLAGS_MATRIX="-O$level" >/dev/null  # assertions on
    cmake --build "$build" -- --quiet
    builds+=("$build")
  done
done
tests/same_pixels.sh "${builds[@]}"
for build in "${builds[@]:2}"; do
  ctest --test-dir "$build" -j "$(nproc)" --output-on-failure --no-tests=error
done
