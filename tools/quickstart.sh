#!/usr/bin/env bash
# From nothing to a Reeb graph: installs what is missing, builds the program, and computes the Reeb
# graph of a mesh.
#
#   tools/quickstart.sh [MESH [OPTION...]]
#
# OPTIONs go to `reeb compute`, for instance `-f x`. Without MESH it takes a real one, the surface
# of a motorcycle with its rider (331,653 triangles, 139 loops along z), from the Debian package
# openfoam-examples; the package is unpacked below build/, not installed. The results are written
# to build/quickstart/: NAME.reeb, and of the coarsest shape NAME.rg and a picture, NAME.svg.
set -euo pipefail
cd_project() { cd "$(dirname "${BASH_SOURCE[0]}")/.."; }

step() { printf '== %s\n' "$1" >&2; }
timed() {  # timed WHAT COMMAND...: runs it and says how long it took
  local what=$1 start end
  shift
  step "$what"
  start=$(date +%s%N)
  "$@"
  end=$(date +%s%N)
  printf '   %d.%02d s\n' $(((end - start) / 1000000000)) $(((end - start) / 10000000 % 100)) >&2
}

build_program() {
  cmake -S . -B build/quickstart/cmake -G Ninja -DCMAKE_BUILD_TYPE=Release -DREEB_TESTS=OFF \
    -DREEB_BENCH=OFF >/dev/null
  cmake --build build/quickstart/cmake --target reeb_program
}

