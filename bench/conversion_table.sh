#!/usr/bin/env bash
# What each order of a mesh costs and gains, as the table of docs/CONVERSION.md: conversion to SMB with
# finalization in every order, the live front of the result, and `reeb compute --graph-only` on it.
#
#   bench/conversion_table.sh [--reeb PROGRAM] [--folder DIR] [--runs N] [--orders "ORDER ..."]
#                             [--functions "FUNC ..."] MESH...
#
# Orders are keep, hilbert, spectral, sweep:FUNC, and input: the mesh as it is, not converted. By default
# these with sweep:z and sweep:random:1, a random order; functions are x, y, z and random:1. A cell is
# seconds / peak MiB of the process, the median of N runs (default 3).
#
# Cells are kept in DIR/cells (default DIR: build/bench), and existing ones are not measured again, so an
# interrupted table is resumed. Remove the folder to measure again.
#
# Before the rows of a mesh are printed, its graphs in all orders are compared. Conversion renumbers
# vertices, so ties are decided differently and random functions change. The persistence pairs of x, y and z
# with a persistence above 0 do not depend on ties, and must be the same, value for value.
set -euo pipefail
shopt -s inherit_errexit
cd "$(dirname "$0")/.."

reeb=build/release/tools/reeb folder=build/bench runs=3
orders=(input keep hilbert spectral sweep:z sweep:random:1)
functions=(x y z random:1)
meshes=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --reeb) reeb=$2; shift 2 ;;
    --folder) folder=$2; shift 2 ;;
    --runs) runs=$2; shift 2 ;;
    --orders) read -r -a orders <<<"$2"; shift 2 ;;
    --functions) read -r -a functions <<<"$2"; shift 2 ;;
    *) meshes+=("$1"); shift ;;
  esac
done
[[ ${#meshes[@]} -gt 0 ]] || { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; exit 2; }
mkdir -p "$folder/cells"
stream=$folder/ordered.smb out=$folder/ordered.reeb
trap 'rm -f "$stream" "$out" "$folder/ordered" "$folder/time"' EXIT

fail() { echo "error: $1" >&2; exit 1; }

# cell NAME COMMAND...: the output of the command, kept for the next time.
cell() {
  local kept=$folder/cells/$mesh_name.$order.$1
  if [[ ! -e $kept ]]; then
    "${@:2}" >"$kept.new"
    mv "$kept.new" "$kept"
  fi
  cat "$kept"
}

# timed COMMAND...: "seconds / MiB", the median of the runs.
timed() {
  for ((i = 0; i < runs; ++i)); do
    /usr/bin/time -q -f '%e %M' -o "$folder/time" "$@" >/dev/null || return
    cat "$folder/time"
  done | sort -n | awk -v n="$runs" 'NR == int((n + 1) / 2) { printf "%.1f / %.0f", $1, $2 / 1024 }'
}

# ordered: the mesh in the current order.
ordered() {
  if [[ $order == input ]]; then
    echo "$mesh"
    return
  fi
  [[ $(cat "$folder/ordered" 2>/dev/null) == "$mesh $order" && -e $stream ]] || convert
  echo "$stream"
}
convert() {
  "$reeb" convert "$mesh" "$stream" --finalize --order "$order" --force --quiet
  echo "$mesh $order" >"$folder/ordered"
}
conversion() {
  [[ $order == input ]] && echo – && return
  timed "$reeb" convert "$mesh" "$stream" --finalize --order "$order" --force --quiet
  echo "$mesh $order" >"$folder/ordered"
}
front() { "$reeb" info --json "$(ordered)" | sed -n 's/.*"live_front": \([0-9]*\).*/\1/p' | head -1; }
compute() { timed "$reeb" compute "$(ordered)" -f "$1" --graph-only -o "$out" --force --quiet; }

# Digests of the pairs of x, y and z: types and values.
invariants() {
  for function in x y z; do
    "$reeb" compute "$(ordered)" -f "$function" -o "$out" --force --quiet
    "$reeb" pairs "$out" | awk -F, 'NR > 1 && $6 > 0 { print $1, $4, $5 }' | LC_ALL=C sort | md5sum | cut -c 1-12
  done | paste -s -d ' '
}

echo "| mesh | order | conversion | front |$(printf ' %s |' "${functions[@]}")"
echo "|---|---|---|---|$(printf -- '---|%.0s' "${functions[@]}")"
for mesh in "${meshes[@]}"; do
  mesh_name=$(basename "$mesh")
  rows=() expected=
  for order in "${orders[@]}"; do
    row="| $mesh_name | $order | $(cell conversion conversion) |"
    found=$(cell pairs invariants)
    [[ ${expected:=$found} == "$found" ]] || fail "$mesh: the pairs in the order $order are others: $found instead of $expected"
    row+=" $(cell front front) |"
    for function in "${functions[@]}"; do row+=" $(cell "$function" compute "$function") |"; done
    rows+=("$row")
  done
  printf '%s\n' "${rows[@]}"
  echo "$mesh: the pairs of x, y and z are equal in all orders ($expected)" >&2
done
