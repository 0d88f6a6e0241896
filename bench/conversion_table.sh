#!/usr/bin/env bash
# What the order of a mesh costs and gives, as the table of docs/CONVERSION.md: conversion to SMB with
# finalization in every order, the live front of the result, and `reeb compute --graph-only` on it.
#
#   bench/conversion_table.sh [--reeb PROGRAM] [--folder DIR] [--runs N] [--orders "ORDER ..."] MESH...
#
# Orders are keep, hilbert, spectral, sweep:FUNC; by default these with sweep:z and sweep:random:1, a
# random order. Streams are made in DIR (default: build/bench) and removed. Before anything is printed of
# a mesh, its graphs in all orders are held against each other. Conversion numbers vertices anew, which
# settles ties otherwise and gives other random functions; but the persistence pairs of x, y and z that
# are not of persistence 0 do not depend on ties, and must be the same, value for value. A cell is
# seconds / peak MiB of the process, the median of N runs (default 3).
set -euo pipefail
cd "$(dirname "$0")/.."

reeb=build/release/tools/reeb folder=build/bench runs=3
orders=(keep hilbert spectral sweep:z sweep:random:1)
functions=(x y z random:1)
meshes=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --reeb) reeb=$2; shift 2 ;;
    --folder) folder=$2; shift 2 ;;
    --runs) runs=$2; shift 2 ;;
    --orders) read -r -a orders <<<"$2"; shift 2 ;;
    *) meshes+=("$1"); shift ;;
  esac
done
[[ ${#meshes[@]} -gt 0 ]] || { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; exit 2; }
mkdir -p "$folder"
stream=$folder/ordered.smb out=$folder/ordered.reeb
trap 'rm -f "$stream" "$out"' EXIT

fail() { echo "error: $1" >&2; exit 1; }

# timed COMMAND...: "seconds / MiB", the median of the runs.
timed() {
  for ((i = 0; i < runs; ++i)); do /usr/bin/time -f '%e %M' "$@" 2>&1 >/dev/null | tail -1; done |
    sort -n | awk -v n="$runs" 'NR == int((n + 1) / 2) { printf "%.1f / %.0f", $1, $2 / 1024 }'
}

# Digests of the pairs of x, y and z in the stream: types and values.
invariants() {
  for function in x y z; do
    "$reeb" compute "$stream" -f "$function" -o "$out" --force --quiet
    "$reeb" pairs "$out" | awk -F, 'NR > 1 && $6 > 0 { print $1, $4, $5 }' | LC_ALL=C sort | md5sum | cut -c 1-12
  done | paste -s -d ' '
}

echo "| mesh | order | conversion | front |$(printf ' %s |' "${functions[@]}")"
echo "|---|---|---|---|$(printf -- '---|%.0s' "${functions[@]}")"
for mesh in "${meshes[@]}"; do
  rows=() expected=
  for order in "${orders[@]}"; do
    conversion=$(timed "$reeb" convert "$mesh" "$stream" --finalize --order "$order" --force --quiet)
    found=$(invariants)
    [[ ${expected:=$found} == "$found" ]] || fail "$mesh: the pairs in the order $order are others: $found instead of $expected"
    front=$("$reeb" info --json "$stream" | sed -n 's/.*"live_front": \([0-9]*\).*/\1/p' | head -1)
    row="| $(basename "$mesh") | $order | $conversion | $front |"
    for function in "${functions[@]}"; do
      row+=" $(timed "$reeb" compute "$stream" -f "$function" --graph-only -o "$out" --force --quiet) |"
    done
    rows+=("$row")
  done
  printf '%s\n' "${rows[@]}"
  echo "$mesh: the pairs of x, y and z are equal in all orders ($expected)" >&2
done
