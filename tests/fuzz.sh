#!/usr/bin/env bash
# tests/fuzz.sh MINUTES [TARGET...]
# Builds the fuzzers with clang and runs the targets one after the other, each for that time. Without a name: all of
# them. What they find is kept in build/fuzz/findings, what they learn in build/fuzz/corpus. Prints a line for each
# target. Exit code 1 if something was found. tests/fuzz/README.md says how to run a finding again.
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=${1:?usage: tests/fuzz.sh MINUTES [TARGET...]}
shift

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
fuzzer=$PWD/build/fuzz/tests/reeb_fuzz
[ $# -gt 0 ] || set -- $("$fuzzer" 2>&1 | grep -o -e '--target=[a-z-]*' | cut -d= -f2)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p build/fuzz/findings "$work/tmp"
found=0
for target in "$@"; do
  corpus=build/fuzz/corpus/$target
  mkdir -p "$corpus" "$work/$target"
  "$fuzzer" --target="$target" --write-corpus="$work/$target"
  status=0
  TMPDIR=$work/tmp nice -n 10 "$fuzzer" --target="$target" -max_total_time=$((minutes * 60)) -max_len=6000 -timeout=20 \
    -malloc_limit_mb=256 -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$target-" \
    "$corpus" "$work/$target" >"$work/log" 2>&1 || status=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/log")
  echo "$target: ${runs:-no} executions, $(ls "$corpus" | wc -l) inputs kept$([ $status = 0 ] || echo ", FAILED")"
  [ $status = 0 ] || { found=1; tail -n 40 "$work/log"; }
done
exit $found
