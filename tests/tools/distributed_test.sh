#!/bin/bash
# The Makefile and the Dask graph of docs/DISTRIBUTED.md, as they are there: the same bytes as one run.
# Usage: distributed_test.sh SOURCE_DIR REEB
set -euo pipefail
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

# A part of a file of triangles reads its share, and not what is before or after. It reads the names of all parts.
bytes_read() {
  bash -c '"$@" > /dev/null || exit
    while read -r key value; do test "$key" != rchar: || echo "$value"; done < /proc/self/io' - "$@"
}
if [ -r /proc/self/io ]; then
  reeb generate scan --triangles 2M -o large.ply > /dev/null
  for part in 1 2 3 4 5 6 7 8; do
    reeb fragment large.ply --scan --part $part/8 -o large-$part.names --quiet
  done
  size=$(stat -c %s large.ply)
  names=$(bytes_read reeb fragment large.ply --scan --part 7/8 -o large-7.names --quiet --force)
  share=$(bytes_read reeb fragment large.ply --part 7/8 --shared large-*.names -o large.fragment --quiet)
  test "$names" -lt $((size / 4)) || { echo "names of an eighth: $names bytes of $size were read"; exit 1; }
  test "$share" -lt $((size / 2)) || { echo "an eighth: $share bytes of $size were read"; exit 1; }
  rm large*
else
  echo "skipped: not here: /proc/self/io, which counts the bytes that a part reads"
fi

python=/usr/bin/python3
if ! $python -c "import distributed" 2> /dev/null; then
  echo "skipped: python3-distributed is not installed"
  exit 0
fi
block python > tree.py
$python tree.py scan.ply 5 dask.reeb
expect_same dask.reeb dask
echo "make and dask: the bytes of one run"
