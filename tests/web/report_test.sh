#!/usr/bin/env bash
# The page of `reeb report` in a browser: report_test.mjs; and its HTML, by tidy.
#
#   report_test.sh SOURCE_FOLDER REEB
set -euo pipefail
source=$1 reeb=$2
if ! "$source/tools/install_packages.sh" chromium tidy >/dev/null; then
  echo "skipped: not here: chromium and tidy cannot be installed"
  exit 0
fi
node=$source/tests/web/node.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$reeb" generate scan --triangles 20k -o scan.ply
"$reeb" scan.ply --quiet
"$reeb" report scan.reeb --mesh scan.ply -o scan.html --quiet
printf 'OFF\n0 0 0\n' >empty.off
printf 'OFF\n1 0 0\n1 2 3\n' >point.off
awk -f "$source/tests/web/flat.awk" >flat.off
for name in empty point flat; do
  "$reeb" "$name.off" --quiet
  "$reeb" report "$name.reeb" --mesh "$name.off" -o "$name.html" --quiet
done
"$reeb" generate terrain --triangles 20k -o terrain.ply
"$reeb" terrain.ply --quiet
"$reeb" report terrain.reeb --mesh terrain.ply -o terrain.html --quiet
"$reeb" scan.ply --graph-only --buckets 0 -o bare.reeb --quiet
"$reeb" report bare.reeb -o bare.html --nodes 100k

# A path of 61 nodes, and 150 components of two nodes.
awk -f "$source/tests/web/parts.awk" >parts.obj
"$reeb" parts.obj --quiet
"$reeb" report parts.reeb -o parts.html --quiet

failures=0
for page in *.html; do
  if tidy -quiet -errors "$page"; then echo "ok: tidy finds nothing in $page"; else failures=1; fi
done
"$node" "$source/tests/web/report_test.mjs" "$reeb" "$work" || failures=1
exit $failures
