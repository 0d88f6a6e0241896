#!/usr/bin/env bash
# No crossing triangles in repaired meshes, as counted by CGAL (Debian's libcgal-dev).
#
#   crossing_triangles_test.sh REEB COMPILER
set -euo pipefail
reeb=$1 compiler=$2
if [[ ! -e /usr/include/CGAL/Surface_mesh.h ]]; then
  echo "skipped: not here: libcgal-dev is not installed"
  exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$compiler" -std=c++17 -O1 -w "$(dirname "$0")/crossing_triangles.cpp" -o "$folder/count" -lgmp -lmpfr
cd "$folder"
"$reeb" generate scan --triangles 300k -o scan.ply 2>/dev/null
"$reeb" generate torus --triangles 4000 -o torus.ply 2>/dev/null
for name in scan torus; do
  "$reeb" repair $name.ply --all -o $name-repaired.ply --log $name.json --quiet
  grep -q '"left": \[\]' $name.json || { echo "loops of $name are left"; exit 1; }
  "$reeb" convert $name-repaired.ply $name.off --quiet
  pairs=$(./count $name.off)
  if [[ $pairs != 0 ]]; then
    echo "$pairs pairs of triangles cross in the repaired $name"
    exit 1
  fi
done
# The program that counts sees a crossing: a triangle through another one.
printf 'OFF\n6 2 0\n0 0 0\n2 0 0\n0 2 0\n0.5 0.5 -1\n0.5 0.5 1\n3 3 0.5\n3 0 1 2\n3 3 4 5\n' > cross.off
[[ $(./count cross.off) == 1 ]] || { echo "the counter is blind"; exit 1; }
echo "no triangles cross"
