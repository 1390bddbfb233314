#!/bin/sh
# run.sh [SECONDS]: builds the fuzzers of the readers (each NAME_fuzz.cc here) with clang, and runs each for its share of
# SECONDS (60). New inputs stay in the build folder; a crash ends the run and leaves its input there, to be added to
# corpus/.
set -eu
seconds=${1:-60}
here=$(cd "$(dirname "$0")" && pwd)
build=${LIKENESS_FUZZ_BUILD:-"$here/../../build/fuzz"}
clang=$(command -v clang++-19 || command -v clang++) || {
  echo "run.sh: no clang++-19; install clang-19 and libclang-rt-19-dev" >&2
  exit 2
}
cmake -S "$here/standalone" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$clang" >"$build.log" 2>&1 ||
  { cat "$build.log" >&2; exit 1; }
cmake --build "$build" -j 2 --target fuzzers
cd "$build"
formats=$(basename -s _fuzz.cc "$here"/*_fuzz.cc)
each=$((seconds / $(echo "$formats" | wc -l)))
for format in $formats; do
  mkdir -p "found/$format"
  echo "$format: $each s"
  if ! "./tests/fuzz/${format}_fuzz" -max_total_time=$each -max_len=8192 -timeout=10 -rss_limit_mb=1024 \
    -print_final_stats=1 -artifact_prefix="$format-" "found/$format" "$here/corpus/$format" >"$format.log" 2>&1; then
    tail -40 "$format.log" >&2
    echo "run.sh: $format failed; its input is $build/$format-*, the whole log $build/$format.log" >&2
    exit 1
  fi
  grep "number_of_executed_units" "$format.log"
done
