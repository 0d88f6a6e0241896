#!/usr/bin/env bash
# Exports opened by other programs, as far as they are installed: foreign_exports.py.
#
#   foreign_exports_test.sh REEB
set -euo pipefail
python=/usr/bin/python3 programs=()
found() {  # found NAME PACKAGE COMMAND...: `not here:` before the package if the tests do not install it
  if "${@:3}" >/dev/null 2>&1; then
    programs+=("$1")
  else
    echo "skipped: $2 is not installed"
  fi
}
found vtk "not here: python3-vtk9" "$python" -c 'import vtkmodules.vtkIOXML'
found networkx python3-networkx "$python" -c 'import networkx'
found graphviz graphviz dot -V
found assimp "not here: assimp-utils" assimp version
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" "$(dirname "$0")/foreign_exports.py" "$1" "$folder" "${programs[@]}"
