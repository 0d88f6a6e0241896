#!/usr/bin/env bash
# Times whole runs of `reeb compute` on generated meshes, as a table: wall and processor seconds,
# triangles per second, peak resident memory of the process.
#
#   bench/whole_runs.sh [--reeb PROGRAM] [--folder DIR] [--runs N] [TRIANGLES...]
#
# TRIANGLES default to 1M 4M 12M. Meshes are made once in DIR (default: build/bench) and kept. Every
# answer is verified before it is timed: the surface is closed and orientable with known genus, so
# the graph of the height has at most that many loops and exactly one component; the flat grid has
# one arc. Each line is the median of N runs (default 3). A mesh of 1,000 triangles, run 21 times, shows
# the start-up time. An OBJ file shows the time of the single pass over a mesh without finalization.
set -euo pipefail
cd "$(dirname "$0")/.."

reeb=build/release/tools/reeb folder=build/bench runs=3
sizes=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --reeb) reeb=$2; shift 2 ;;
    --folder) folder=$2; shift 2 ;;
    --runs) runs=$2; shift 2 ;;
    *) sizes+=("$1"); shift ;;
  esac
done
[[ ${#sizes[@]} -gt 0 ]] || sizes=(1M 4M 12M)
mkdir -p "$folder"

fail() { echo "error: $1" >&2; exit 1; }

# mesh NAME KIND OPTION...: makes the mesh unless it is there.
mesh() {
  local path=$folder/$1.ply
  [[ -e $path ]] || "$reeb" generate "$2" -o "$path" "${@:3}" 2>"$folder/$1.topology"
}

# field REPORT NAME: the first number of that name.
field() { sed -n "s/.*\"$2\": \([0-9.e+-]*\).*/\1/p" "$1" | head -1; }

# row NAME LABEL OPTION...: verifies once, then prints the median of the runs. $file is the mesh if it is not
# NAME.ply.
row() {
  local name=$1 label=$2 report=$folder/report.json out=$folder/out.reeb
  local path=$folder/${file:-$name.ply}
  shift 2
  "$reeb" compute "$path" -o "$out" --force --quiet --report "$report" "$@"
  local genus; genus=$(sed -n 's/.*genus \([0-9]*\).*/\1/p' "$folder/$name.topology")
  [[ $(field "$report" components) == 1 ]] || fail "$name: not one component"
  [[ -z $genus || $(field "$report" loops) -le $genus ]] || fail "$name: more loops than the genus"
  local triangles; triangles=$(field "$report" triangles)
  for ((i = 0; i < runs; ++i)); do
    /usr/bin/time -f '%e %U %S %M' "$reeb" compute "$path" -o "$out" --force --quiet "$@" 2>&1
  done | sort -n | awk -v n="$runs" -v t="$triangles" -v name="$name" -v label="$label" '
    { line[NR] = $0 }
    END { split(line[int((n + 1) / 2)], m, " ")
          printf "| %s | %s | %.2f s | %.2f s | %.1f | %.1f MB |\n", name, label, m[1], m[2] + m[3], t / m[1] / 1e6, m[4] / 1024 }'
}

# The time of a process as its caller sees it, finer than /usr/bin/time tells.
start_up() {
  mesh torus-1k torus --triangles 1k
  local out=$folder/out.reeb before after peak
  peak=$(/usr/bin/time -f %M "$reeb" compute "$folder/torus-1k.ply" -o "$out" --force --quiet 2>&1)
  for ((i = 0; i < 21; ++i)); do
    before=${EPOCHREALTIME/[.,]/}
    "$reeb" compute "$folder/torus-1k.ply" -o "$out" --force --quiet
    after=${EPOCHREALTIME/[.,]/}
    echo $((after - before))
  done | sort -n | awk -v peak="$peak" '
    { us[NR] = $1 }
    END { printf "start-up on 1,000 triangles, 21 runs: %.1f ms at least, %.1f ms median; peak memory %.1f MB\n\n",
                 us[1] / 1000, us[11] / 1000, peak / 1024 }'
}

start_up
echo "| mesh | run | wall | processor | M triangles/s | peak memory |"
echo "|---|---|---|---|---|---|"
for size in "${sizes[@]}"; do
  for order in patches rows; do
    mesh "scan-$size-$order" scan --triangles "$size" --order "$order"
    row "scan-$size-$order" "z, 1 thread" --graph-only --threads 1
    row "scan-$size-$order" "z, 2 threads" --graph-only --threads 2
    row "scan-$size-$order" "random:1, 2 threads" --graph-only --threads 2 -f random:1
    row "scan-$size-$order" "z with hierarchy, 2 threads" --threads 2
  done
  [[ -e $folder/scan-$size-patches.obj ]] || "$reeb" convert "$folder/scan-$size-patches.ply" "$folder/scan-$size-patches.obj" 2>/dev/null
  file=scan-$size-patches.obj row "scan-$size-patches" "z, OBJ, 1 thread" --graph-only --threads 1
  file=scan-$size-patches.obj row "scan-$size-patches" "z, OBJ, 2 threads" --graph-only --threads 2
  mesh "scan-$size-random" scan --triangles "$size" --order random
  row "scan-$size-random" "z, --memory 64M" --graph-only --threads 2 --memory 64M
  mesh "grid-$size-rows" grid --triangles "$size" --order rows
  row "grid-$size-rows" "x, across the stream" --graph-only --threads 2 -f x
  row "grid-$size-rows" "y, along the stream, ties" --graph-only --threads 2 -f y
  mesh "scan-$size-wide" scan --triangles "$size" --order rows --width 20000
  row "scan-$size-wide" "z, front of 20,000 cells" --graph-only --threads 2
done
rm -f "$folder/out.reeb" "$folder/report.json"
