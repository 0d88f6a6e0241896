#!/usr/bin/env bash
# What an embedding and noise removal cost: runs of `reeb compute --graph-only` with and without
# them, in turns, on the same mesh; and how they change the sizes of the stored files.
#
#   bench/overhead.sh [--reeb PROGRAM] [--folder DIR] [--runs N] [--threads N] [TRIANGLES...]
#
# TRIANGLES default to 12M. The mesh is made once in DIR (default: build/bench) and kept. Every run
# is paired with one that computes the graph only. The overheads are medians of the quotients of N
# pairs (default 9): of processor time, which other programs disturb least, and of wall time.
# Without noise removal the graph must have the same number of nodes with an embedding as without.
set -euo pipefail
cd "$(dirname "$0")/.."

reeb=build/release/tools/reeb folder=build/bench runs=9 threads=2
sizes=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --reeb) reeb=$2; shift 2 ;;
    --folder) folder=$2; shift 2 ;;
    --runs) runs=$2; shift 2 ;;
    --threads) threads=$2; shift 2 ;;
    *) sizes+=("$1"); shift ;;
  esac
done
[[ ${#sizes[@]} -gt 0 ]] || sizes=(12M)
mkdir -p "$folder"
report=$folder/overhead.json out=$folder/overhead.reeb

fail() { echo "error: $1" >&2; exit 1; }

# compute OPTION...: one run on the current mesh.
compute() {
  "$reeb" compute "$mesh" -o "$out" --force --quiet --graph-only --threads "$threads" -f "$function" "$@"
}

# field NAME: the first number of that name in the report.
field() { sed -n "s/.*\"$1\": \([0-9.e+-]*\).*/\1/p" "$report" | head -1; }

# timed OPTION...: prints processor and wall seconds.
timed() { ( TIMEFORMAT='%U %S %R'; time compute "$@" ) 2>&1 | awk '{ print $1 + $2, $3 }'; }

# row BUCKETS DENOISE: the overhead over the graph alone, and the sizes.
row() {
  compute --buckets "$1" --denoise "$2" --report "$report"
  [[ $2 != 0 || $(field nodes) == "$nodes" ]] || fail "$function: an embedding changes the graph"
  local spilled=$(($(field spilled_bytes) - tables)) arcs bytes
  arcs=$(field arcs) bytes=$(stat -c %s "$out")
  for ((i = 0; i < runs; ++i)); do
    echo "$(timed --buckets 0) $(timed --buckets "$1" --denoise "$2")"
  done | awk -v label="| $function | $1 | $2 |" -v spilled="$spilled" -v arcs="$arcs" -v bytes="$bytes" '
    function median(values, n,   i, j, t) {
      for (i = 2; i <= n; ++i)
        for (j = i; j > 1 && values[j] < values[j - 1]; --j) { t = values[j]; values[j] = values[j - 1]; values[j - 1] = t }
      return values[int((n + 1) / 2)]
    }
    { processor[NR] = $3 / $1; wall[NR] = $4 / $2; seconds[NR] = $3 }
    END { printf "%s %.2f s | %+.1f %% | %+.1f %% | %d | %.1f MB | %.1f MB |\n", label, median(seconds, NR),
                 100 * (median(processor, NR) - 1), 100 * (median(wall, NR) - 1), arcs, spilled / 1e6, bytes / 1e6 }'
}

echo "| function | buckets | denoise | processor | overhead, processor | overhead, wall | arcs | spilled | file |"
echo "|---|---|---|---|---|---|---|---|---|"
for size in "${sizes[@]}"; do
  mesh=$folder/scan-$size-patches.ply
  [[ -e $mesh ]] || "$reeb" generate scan -o "$mesh" --triangles "$size" --order patches 2>"${mesh%.ply}.topology"
  for function in z random:1; do
    # The bytes spilled by the table of last uses do not depend on the graph: measured by a run without noise.
    compute --buckets 0 --denoise 100% --report "$report"
    tables=$(field spilled_bytes)
    compute --buckets 0 --report "$report"
    nodes=$(field nodes)
    for buckets in 0 64; do
      for denoise in 0 0.01% 0.1% 1%; do row "$buckets" "$denoise"; done
    done
  done
done
rm -f "$out" "$report"
