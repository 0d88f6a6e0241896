#!/bin/bash
# reeb-mpi: the same bytes as one process, and what it leaves when a rank fails or is killed.
# With REEB_TEST_ALL=1 also of every real mesh.
# Usage: mpi_test.sh REEB REEB_MPI SOURCE_DIR
set -euo pipefail
reeb=$1 reeb_mpi=${2:-} meshes=${REEB_DATA:-${3:-}/../shared/data}/meshes
if [ ! -f "$reeb_mpi" ] || ! command -v mpirun > /dev/null; then
  echo "skipped: libopenmpi-dev or openmpi-bin is not installed, or this build is without REEB_MPI"
  exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
export TMPDIR=$work
mpi() { local ranks=$1; shift; mpirun --oversubscribe -n "$ranks" "$reeb_mpi" compute "$@" < /dev/null; }
fail() { echo "$1"; exit 1; }
expect_same() { cmp one.reeb all.reeb || fail "$1: not the bytes of one process"; }
expect_clean() { test -z "$(find . -name '*rank-*')" || fail "$1: files of ranks are left: $(ls)"; }

"$reeb" generate scan --triangles 20k -o scan.ply > /dev/null
"$reeb" compute scan.ply --buckets 0 -o one.reeb --quiet
for ranks in 1 2 3 5 8; do
  mpi $ranks scan.ply --buckets 0 -o all.reeb --quiet --force --threads 1
  expect_same "$ranks ranks"
  expect_clean "$ranks ranks"
done
"$reeb" generate scan --triangles 6k --order random -o random.ply > /dev/null
"$reeb" compute random.ply --buckets 0 --denoise 1% -f x -o one.reeb --quiet --force
mpi 3 random.ply --buckets 0 --denoise 1% -f x -o all.reeb --quiet --force
expect_same "random order, noise removed"
"$reeb" generate grid --triangles 20k --width 3000 -o wide.ply > /dev/null
"$reeb" compute wide.ply --graph-only --buckets 0 -f random:1 -o one.reeb --quiet --force
mpi 5 wide.ply --graph-only --buckets 0 -f random:1 -o all.reeb --quiet --force --threads 1
expect_same "long rows"


# Several functions; the figures of all ranks.
"$reeb" compute scan.ply --buckets 0 -f x -f y -o one.reeb --quiet --force
mpi 3 scan.ply --buckets 0 -f x -f y -o all.reeb --report all.json --quiet
for f in x y; do cmp "one-$f.reeb" "all-$f.reeb" || fail "several functions: not the bytes of one process"; done
expect_clean "several functions"
grep -q '"names_bytes"' all.json || fail "the report has no figures of ranks"
test "$(grep -c '"share_ms"' all.json)" = 8 || fail "the report has not the figures of each rank: $(cat all.json)"

# A quadrilateral and an edge together have the size of two triangles, by which a rank finds its share.
{
  printf 'ply\nformat binary_little_endian 1.0\nelement vertex 6\nproperty float x\nproperty float y\n'
  printf 'element face 4\nproperty list uchar uchar vertex_indices\nend_header\n'
  printf '\0\0\0\0\0\0\0\0' && printf '\0\0\0\0\0\0\0\100' && printf '\0\0\0\0\0\0\200\077'
  printf '\0\0\0\0\0\0\200\100' && printf '\0\0\0\0\0\0\100\100' && printf '\0\0\0\0\0\0\240\100'
  printf '\3\0\1\2\4\1\2\3\4\2\4\5\3\2\3\5'
} > odd.ply
"$reeb" compute odd.ply -f y --buckets 0 -o one.reeb --quiet --force
for ranks in 1 2 3; do
  mpi $ranks odd.ply -f y --buckets 0 -o all.reeb --quiet --force --threads 1
  expect_same "polygons and edges, $ranks ranks"
done

if [ -n "${REEB_TEST_ALL:-}" ] && [ -d "$meshes" ]; then
  for mesh in "$meshes"/*.{obj,ply,stl,off,vtk,gz}; do
    "$reeb" compute "$mesh" --buckets 0 -o one.reeb --quiet --force
    for ranks in 1 2 3 5 8; do
      mpi $ranks "$mesh" --buckets 0 -o all.reeb --quiet --force --threads 1
      expect_same "$mesh, $ranks ranks"
    done
  done
fi

# One text, the exit code, no output.
expect_failure() {
  test $code = "$2" || fail "$1: exit code $code: $(cat error.txt)"
  test "$(grep -c 'error: ' error.txt)" = 1 || fail "$1: not one text: $(cat error.txt)"
  test ! -e none.reeb || fail "$1: there is an output"
}
"$reeb_mpi" --version > version.txt
grep -q '^reeb-mpi [0-9]' version.txt || fail "--version: no version"
code=0
"$reeb_mpi" scan.ply 2> error.txt || code=$?
expect_failure "a mesh without a command" 2
grep -q "^hint: write reeb-mpi compute scan.ply -o OUT.reeb" error.txt || fail "no hint: $(cat error.txt)"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 1\nodd line\nf 1 2 3\n' > odd.obj
mpi 2 odd.obj -o odd.reeb -f laplacian:1 2> error.txt > output.txt
grep -q "1 unknown line was skipped" output.txt error.txt || fail "no note on the line: $(cat output.txt error.txt)"
grep -q "eigenvalue" output.txt error.txt || fail "no note on the eigenvalue: $(cat output.txt error.txt)"
code=0
mpi 2 nothing.ply -o none.reeb 2> error.txt || code=$?
expect_failure "a missing mesh" 1
grep -q "reeb-mpi: error: nothing.ply" error.txt || fail "a missing mesh: no error: $(cat error.txt)"
code=0
mpi 3 scan.ply --bogus 2> error.txt || code=$?
expect_failure "an unknown option" 2
code=0
mpi 3 scan.ply -o none.reeb --memory 1M 2> error.txt || code=$?
expect_failure "too little memory" 3
# Only one of the ranks has too little.
code=0
mpirun --oversubscribe -n 2 "$reeb_mpi" compute scan.ply -o none.reeb --quiet : \
  -n 1 "$reeb_mpi" compute scan.ply -o none.reeb --quiet --memory 1M < /dev/null 2> error.txt || code=$?
expect_failure "too little memory in one rank" 3
mpi 3 scan.ply -o none.reeb --quiet --resume
expect_clean "a run after one that failed"

# A rank is killed, sooner or later; --resume continues, also after a second kill. Another number of ranks begins
# again, and leaves nothing.
"$reeb" generate scan --triangles 400k -o scan.ply --force > /dev/null
"$reeb" compute scan.ply --buckets 0 -o one.reeb --quiet --force
start() {
  REEB_CHECKPOINT_SECONDS=0 mpirun --oversubscribe -n 3 "$reeb_mpi" compute scan.ply --buckets 0 -o killed.reeb \
    --quiet --threads 1 "$@" < /dev/null 2> error.txt &
  run=$!
}
# kill_rank K PATTERN: once a file of this name exists.
kill_rank() {
  local file= pid= code=0
  for _ in $(seq 1000); do
    file=$(compgen -G "$2" || true)
    if [ -n "$file" ] || ! kill -0 $run 2> /dev/null; then break; fi
    sleep 0.01
  done
  pid=$(pgrep -P $run -x reeb-mpi | sed -n "$1p" || true)
  if [ -n "$pid" ]; then kill -KILL "$pid" && killed=$((killed + 1)); fi
  wait $run || code=$?
  # It may have been whole already.
  if [ -e killed.reeb ]; then
    cmp one.reeb killed.reeb || fail "a killed rank: there is an output"
    rm killed.reeb
  elif [ $code = 0 ]; then
    fail "a killed rank: exit code 0"
  fi
}
killed=0
start
kill_rank 2 "killed.reeb.rank-1-share.fragment.partial/checkpoint"
start --resume
kill_rank 1 "killed.reeb.rank-2-share.fragment"
start --resume
kill_rank 3 "killed.reeb.rank-*-tree.fragment"
mpi 3 scan.ply --buckets 0 -o killed.reeb --quiet --threads 1 --resume
mv killed.reeb all.reeb
expect_same "resumed"
expect_clean "resumed"
start --force
kill_rank 2 "killed.reeb.rank-*-share.fragment"
mpi 2 scan.ply --buckets 0 -o killed.reeb --quiet --threads 1 --force
mv killed.reeb all.reeb
expect_same "after a killed run of more ranks"
expect_clean "after a killed run of more ranks"
test $killed -ge 2 || fail "only $killed ranks could be killed before their runs ended"
echo "1 to 8 ranks, failures, $killed killed ranks, resumed runs: as they should be"
# Last, since ctest does not look at the exit code of a test that says so.
if [ -n "${REEB_TEST_ALL:-}" ] && [ ! -d "$meshes" ]; then
  if [ -z "${REEB_DATA:-}" ]; then
    echo "skipped: no data: there is no $meshes, and REEB_DATA is not set"
  else
    echo "skipped: REEB_DATA is set, but there is no $meshes"
  fi
fi
