#!/usr/bin/env bash
# The viewer: its reader (reader_test.mjs), the server of `reeb view` and the page in a browser (viewer_test.mjs).
#
#   viewer_test.sh SOURCE_FOLDER REEB PACKAGES     PACKAGES has node_modules and viewer.html
set -euo pipefail
source=$1 reeb=$2 packages=$3
node=$source/tests/web/node.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$reeb" generate scan --triangles 200k -o "$work/scan.ply" >/dev/null
"$reeb" "$work/scan.ply" --quiet -o "$work/scan.reeb"
"$reeb" generate torus --triangles 230k -o "$work/many.ply" >/dev/null
"$reeb" "$work/many.ply" -f random:1 --quiet -o "$work/many.reeb"
# A path of 61 nodes, and 150 components of two nodes.
awk -f "$source/tests/web/parts.awk" >"$work/parts.obj"
"$reeb" "$work/parts.obj" --quiet -o "$work/parts.reeb"
# Values that differ in the last bits only.
awk -f "$source/tests/web/flat.awk" >"$work/flat.off"
"$reeb" "$work/flat.off" --buckets 0 --quiet -o "$work/flat.reeb"
cp "$packages/viewer.html" "$work"

# The reader's test has a folder of its own, and runs beside the others.
failures=0
mkdir "$work/reader"
cp "$work/scan.reeb" "$work/reader"
"$node" "$source/tests/web/reader_test.mjs" "$source" "$reeb" "$packages" "$work/reader" &
reader=$!
"$node" "$source/tests/web/view_server_test.mjs" "$reeb" "$work" || failures=1
if "$source/tools/install_packages.sh" chromium tidy >/dev/null; then
  if tidy -quiet -errors "$work/viewer.html"; then echo "ok: tidy finds nothing in viewer.html"; else failures=1; fi
  "$node" "$source/tests/web/viewer_test.mjs" "$source" "$reeb" "$work" || failures=1
else
  echo "skipped: not here: chromium and tidy cannot be installed"
fi
wait $reader || failures=1
exit $failures
