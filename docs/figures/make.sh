#!/usr/bin/env bash
# Makes the figures of the documents that `reeb plot` draws, and those that need no more than the program.
#
#   docs/figures/make.sh REEB MESHES
#
# MESHES is a folder with the meshes that SKELETONS.md names: dragon_vrip.ply.gz, armadillo_86k.obj.gz,
# lucy_100k.ply.gz, head120_iso60.ply.gz, etopo20_terrain.ply.gz, spx_tets.vtk. A figure whose mesh is missing stays as
# it is. fragments.svg, loading.svg, memory.svg and eigenfunctions.png show measurements: their scripts say how to
# repeat them.
set -euo pipefail
[[ $# -eq 2 ]] || { sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 2; }
reeb=$(realpath "$1") meshes=$(realpath "$2")
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# skeleton NAME MESH FUNCTION "COMPUTE OPTIONS" PLOT-OPTION...: docs/skeletons/NAME.png, with fewer pixels than `reeb
# plot -o NAME.png` has.
skeleton() {
  local name=$1 mesh=$2 function=$3 compute=$4
  shift 4
  [[ -r $mesh ]] || { echo "left as it is: $name.png, without $mesh"; return; }
  # shellcheck disable=SC2086
  "$reeb" compute "$mesh" -f "$function" -o "$name.reeb" --quiet $compute
  "$reeb" plot "$name.reeb" --kind skeleton --mesh "$mesh" -o "$name.svg" --quiet "$@"
  local zoom=0.75
  [[ $name != dragon ]] || zoom=1
  rsvg-convert --zoom "$zoom" "$name.svg" -o "$docs/skeletons/$name.png"
  echo "made: skeletons/$name.png"
}

"$reeb" generate torus --triangles 20k -o torus.ply 2>/dev/null
"$reeb" generate plate --triangles 3k -o plate.ply 2>/dev/null
"$reeb" generate scan --triangles 300k -o scan.ply 2>/dev/null
"$reeb" generate terrain --triangles 200k -o terrain.ply 2>/dev/null
skeleton torus torus.ply z "" --threshold 1% --surface glass
skeleton plate plate.ply y "" --color arcs
skeleton scan scan.ply z "--denoise 5%" --threshold 8% --color arcs --surface glass
skeleton terrain terrain.ply z "" --threshold 12% --surface value
skeleton armadillo "$meshes/armadillo_86k.obj.gz" y "" --threshold 2% --color arcs
skeleton dragon "$meshes/dragon_vrip.ply.gz" y "" --threshold 4%
skeleton lucy "$meshes/lucy_100k.ply.gz" z "" --threshold 2%
skeleton head "$meshes/head120_iso60.ply.gz" z "" --threshold 10% --surface glass
skeleton earth "$meshes/etopo20_terrain.ply.gz" z "" --threshold 35% --surface value --view=0,-0.25,1
skeleton spx "$meshes/spx_tets.vtk" z "" --surface glass --view=-0.65,-0.73,0.21

if [[ -r dragon.reeb && -r head.reeb ]]; then
  "$reeb" compute "$meshes/dragon_vrip_res2.ply.gz" -f y -o dragon_res2.reeb --quiet
  "$reeb" plot dragon.reeb dragon_res2.reeb head.reeb -o "$docs/loops.svg" --force --quiet
  "$reeb" plot dragon.reeb --kind diagram -o "$docs/diagram.svg" --force --quiet
  "$reeb" plot dragon.reeb --kind graph --threshold 4% -o "$docs/graph.svg" --force --quiet
  echo "made: loops.svg diagram.svg graph.svg"
fi

python3 "$docs/figures/torus.py" >"$docs/torus.svg"
for d in 2 3 4 5; do
  for k in 1 2 3; do
    "$reeb" generate sierpinski --dimension $d --triangles $(((d + 1) ** k * (d + 1) * d * (d - 1) / 6)) -o s.cx --force \
      2>/dev/null
    "$reeb" compute s.cx -f x -o s.reeb --force --quiet
    "$reeb" extract s.reeb -o $d-$k.json
  done
done
"$docs/figures/sierpinski.py" ?-?.json >sierpinski.svg
mv sierpinski.svg "$docs/sierpinski.svg"
echo "made: torus.svg sierpinski.svg"
