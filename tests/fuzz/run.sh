#!/bin/sh
# run.sh [SECONDS]: builds the eleven fuzzers of the readers with clang and runs each for an eleventh of SECONDS (60).
# New inputs stay in the build folder; a crash ends the run and leaves its input there, to be added to corpus/.
set -eu
seconds=${1:-60}
here=$(cd "$(dirname "$0")" && pwd)
build=${LIKENESS_FUZZ_BUILD:-"$here/../../build/fuzz"}
clang=$(command -v clang++-19 || command -v clang++) || {
  echo "run.sh: no clang++-19; install clang-19 and libclang-rt-19-dev" >&2
  exit 2
}
cmake -S "$here/standalone" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$clang" -DCMAKE_BUILD_TYPE=RelWithDebInfo >"$build.log" 2>&1 ||
  { cat "$build.log" >&2; exit 1; }
cmake --build "$build" -j 2
cd "$build"
for format in merl mbsdf rgl csv table scene glb ply obj ies exr; do
  mkdir -p "found/$format"
  echo "$format: $((seconds / 11)) s"
  if ! "./tests/fuzz/${format}_fuzz" -max_total_time=$((seconds / 11)) -max_len=8192 -timeout=10 -rss_limit_mb=1024 \
    -print_final_stats=1 -artifact_prefix="$format-" "found/$format" "$here/corpus/$format" >"$format.log" 2>&1; then
    tail -40 "$format.log" >&2
    echo "run.sh: $format failed; its input is $build/$format-*, the whole log $build/$format.log" >&2
    exit 1
  fi
  grep "number_of_executed_units" "$format.log"
done
