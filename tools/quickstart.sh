#!/usr/bin/env bash
# From a fresh machine to a Reeb graph: installs what is missing, builds the program, and computes the Reeb
# graph of a mesh.
#
#   tools/quickstart.sh [MESH [OPTION...]]
#
# OPTIONs go to `reeb compute`, for instance `-f x`. Without MESH it uses a real one, the surface
# of a motorcycle with its rider (331,653 triangles), from the Debian package openfoam-examples
# (GPL-3+); the package is unpacked below build/, not installed. Results, in build/quickstart/:
#
#   NAME.reeb  the graph with all its levels of detail
#   NAME.rg    the full graph as text, one node or arc per line
#   NAME.svg   a picture of the finest level of at most 60 nodes, with the function upwards
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$here/build/quickstart
reeb=$here/build/install/tools/reeb

case ${1:-} in
  -h | --help) sed -n '2,15s/^# \{0,1\}//p' "$0"; exit 0 ;;
  -*) echo "error: name the mesh first, then options; see $0 --help" >&2; exit 2 ;;
esac
mesh=${1:-}
shift || true
if [[ -n $mesh && ! -r $mesh ]]; then
  echo "error: $mesh: there is no such file, or it cannot be read" >&2
  exit 1
fi

timed() {  # timed WHAT COMMAND...: runs it and says how long it took
  local what=$1 start end
  shift
  echo "== $what"
  start=$(date +%s%N)
  "$@"
  end=$(date +%s%N)
  printf '== %s: %d.%02d s\n\n' "$what" $(((end - start) / 1000000000)) \
    $(((end - start) / 10000000 % 100))
}

build_program() (
  cd "$here"
  cmake --preset install >"$out/configure-log.txt" 2>&1 || { cat "$out/configure-log.txt"; return 1; }
  cmake --build --preset install --target reeb_program
)

# The package is 36 MB and would install hundreds: take only the file that is needed.
fetch_motorbike() {
  local package=openfoam-examples folder
  folder=$(mktemp -d "$out/package.XXXXXX")
  chmod 755 "$folder"
  (cd "$folder" && apt-get -qq download "$package" 2>/dev/null) ||
    { echo "error: cannot download the Debian package $package; name a mesh of your own: $0 MESH" >&2
      rm -rf "$folder"; return 1; }
  dpkg-deb --fsys-tarfile "$folder"/"$package"_*.deb |
    tar -x -C "$folder" --wildcards --transform='s,.*/,,' '*/resources/geometry/motorBike.obj.gz'
  mv "$folder/motorBike.obj.gz" "$out/"
  rm -rf "$folder"
}

draw() {
  "$reeb" plot "$out/$name.reeb" --kind graph --nodes 60 -o "$out/$name.svg" --force
}

mkdir -p "$out"
timed "install packages" "$here/tools/install_packages.sh" graphviz
timed "build" build_program
if [[ -z $mesh ]]; then
  mesh=$out/motorBike.obj.gz
  [[ -s $mesh ]] || timed "fetch the mesh" fetch_motorbike
fi
name=$(basename "$mesh")
name=${name%.gz}
name=${name%.zst}
name=${name%.*}
timed "compute" "$reeb" compute "$mesh" -o "$out/$name.reeb" --force "$@"
timed "export" "$reeb" extract "$out/$name.reeb" --force -o "$out/$name.rg"
timed "draw" draw

echo "The graph:    $out/$name.reeb"
echo "  as text:    $out/$name.rg"
echo "  a picture:  $out/$name.svg"
echo "Try next:     $reeb extract $out/$name.reeb --threshold 5% -o $name.json"
