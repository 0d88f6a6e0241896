#!/usr/bin/env bash
# How time and memory grow with the size of a mesh, for fronts that grow and fronts that do not: `reeb compute` with noise
# removal and hierarchy on scan-like surfaces, as a table.
#
#   bench/growth.sh [--reeb PROGRAM] [--folder DIR] [--options "OPTION..."] [--tiles] [SIZE...]
#
# SIZE defaults to 1M 4M 12M; 372M takes 7 GB of disk for each order. Meshes are made once in DIR (default:
# build/bench) and kept: `patches`, whose front grows with the square root of the size, and `wide`, rows of a fixed
# width of 9,990 cells, whose front of 20,000 vertices does not grow. With --tiles also `tiles`, `random-tiles` and
# `seams-last` of 32 x 32 cells, like merged scans, whose pieces are read in another order. The graph is verified before a line
# is printed: one component, and no more loops than the genus that the generator reports; the scan has
# exactly as many. OPTIONS default to "--denoise 0.1%".
set -euo pipefail
cd "$(dirname "$0")/.."

reeb=build/release/tools/reeb folder=build/bench options="--denoise 0.1%" tiles=()
sizes=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --reeb) reeb=$2; shift 2 ;;
    --folder) folder=$2; shift 2 ;;
    --options) options=$2; shift 2 ;;
    --tiles) tiles=(tiles random-tiles seams-last); shift ;;
    *) sizes+=("$1"); shift ;;
  esac
done
[[ ${#sizes[@]} -gt 0 ]] || sizes=(1M 4M 12M)
mkdir -p "$folder"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() { echo "error: $1" >&2; exit 1; }

# mesh NAME OPTION...: makes the mesh unless it is there.
mesh() {
  local path=$folder/$1.ply
  [[ -e $path ]] && return
  "$reeb" generate scan -o "$path" "${@:2}" 2>"$folder/$1.topology"
}

# field NAME: the first number of that name in the report.
field() { sed -n "s/.*\"$1\": \([0-9.e+-]*\).*/\1/p" "$scratch/report.json" | head -1; }

# row NAME: one run of a mesh, which is in the page cache as far as it fits.
row() {
  cat "$folder/$1.ply" >/dev/null
  # shellcheck disable=SC2086  # options are words
  /usr/bin/time -o "$scratch/time" -f '%e %U %S %M' \
    "$reeb" compute "$folder/$1.ply" -o "$scratch/out.reeb" --force --quiet --report "$scratch/report.json" $options
  local genus; genus=$(sed -n 's/.*genus \([0-9]*\).*/\1/p' "$folder/$1.topology")
  [[ $(field components) == 1 ]] || fail "$1: not one component"
  [[ -n $genus && $(field loops) -le $genus ]] || fail "$1: more loops than the genus"
  tail -1 "$scratch/time" | awk -v name="$1" -v t="$(field triangles)" -v spilled="$(field spilled_bytes)" \
    -v live="$(sed -n '/"live_max"/,/}/s/.*"vertices": \([0-9]*\).*/\1/p' "$scratch/report.json" | head -1)" '
    { printf "| %s | %.2f s | %.2f s | %.1f | %.1f MB | %.1f MB | %d |\n",
             name, $1, $2 + $3, $1 / t * 1e9, $4 / 1024, spilled / 1e6, live }'
}

echo "| mesh | wall | processor | ns a triangle | peak memory | spilled | live vertices |"
echo "|---|---|---|---|---|---|---|"
for size in "${sizes[@]}"; do
  mesh "scan-$size-patches" --triangles "$size" --order patches
  row "scan-$size-patches"
done
for size in "${sizes[@]}"; do
  mesh "scan-$size-front" --triangles "$size" --order rows --width 9990
  row "scan-$size-front"
done
for order in "${tiles[@]}"; do
  for size in "${sizes[@]}"; do
    mesh "scan-$size-$order" --triangles "$size" --order "$order:32"
    row "scan-$size-$order"
  done
done
