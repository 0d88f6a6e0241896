#!/bin/bash
# The Makefile and the Dask graph of docs/DISTRIBUTED.md, as they are there: the same bytes as one run.
# Usage: distributed_test.sh SOURCE_DIR REEB
set -eu
document=$1/docs/DISTRIBUTED.md reeb=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir bin
ln -s "$reeb" bin/reeb
export PATH=$work/bin:$PATH

block() { awk -v begin="^\`\`\`$1\$" '$0 ~ begin {inside = 1; next} /^```$/ {inside = 0} inside' "$document"; }
expect_same() { cmp "$1" one.reeb || { echo "$2: not the bytes of one run"; exit 1; }; }

reeb generate scan --triangles 20k -o scan.ply > /dev/null
reeb compute scan.ply --buckets 0 -o one.reeb --quiet

block makefile > Makefile
make -s -j 2 PARTS=4
expect_same graph.reeb make
# A lost part is made again alone.
rm part-3.fragment
test "$(make -n | grep -c "reeb fragment")" = 1 || { echo "make: a lost part is not made alone"; exit 1; }

python=/usr/bin/python3
if ! $python -c "import distributed" 2> /dev/null; then
  echo "skipped: no data: there is no python3-distributed"
  exit 0
fi
block python > tree.py
$python tree.py scan.ply 5 dask.reeb
expect_same dask.reeb dask
echo "make and dask: the bytes of one run"
