#!/bin/bash
# reeb-mpi: the same bytes as one process, and what it leaves when a rank fails or is killed.
# Usage: mpi_test.sh REEB REEB_MPI
set -eu
reeb=$1 reeb_mpi=${2:-}
if [ ! -x "$reeb_mpi" ] || ! command -v mpirun > /dev/null; then
  echo "skipped: no data: there is no MPI"
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

# One text, the exit code, no output.
code=0
mpi 2 nothing.ply -o none.reeb 2> error.txt || code=$?
test $code = 1 || fail "a missing mesh: exit code $code"
grep -q "reeb-mpi: error: nothing.ply" error.txt || fail "a missing mesh: no error: $(cat error.txt)"
code=0
mpi 2 scan.ply -o none.reeb --memory 1M 2> error.txt || code=$?
test $code = 3 || fail "too little memory: exit code $code"
test ! -e none.reeb || fail "an output of a run that failed"

# A rank is killed; --resume goes on.
"$reeb" generate scan --triangles 3M -o scan.ply --force > /dev/null
"$reeb" compute scan.ply --buckets 0 -o one.reeb --quiet --force
code=0
REEB_CHECKPOINT_SECONDS=0 mpi 3 scan.ply --buckets 0 -o killed.reeb --quiet --threads 1 2> error.txt &
run=$!
victim=
for _ in $(seq 500); do
  victim=$(ls -d killed.reeb.rank-1-share.fragment.partial/checkpoint 2> /dev/null || true)
  if [ -n "$victim" ]; then break; fi
  sleep 0.02
done
pid=$(pgrep -P "$(pgrep -P $run mpirun || echo $run)" reeb-mpi | sed -n 2p || true)
if [ -n "$pid" ]; then kill -KILL "$pid"; fi
wait $run || code=$?
if [ -n "$pid" ]; then
  test $code != 0 || fail "a killed rank: exit code 0"
  # It may have been whole already.
  test ! -e killed.reeb || cmp one.reeb killed.reeb || fail "a killed rank: there is an output"
fi
mpi 3 scan.ply --buckets 0 -o killed.reeb --quiet --threads 1 --resume --force
mv killed.reeb all.reeb
expect_same "resumed"
expect_clean "resumed"
echo "1 to 8 ranks, failures, ${pid:+a killed rank, }a resumed run: as they should be"
