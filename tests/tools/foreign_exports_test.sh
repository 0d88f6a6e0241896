#!/usr/bin/env bash
# Exports opened by other programs, as far as they are installed: foreign_exports.py.
#
#   foreign_exports_test.sh REEB
set -euo pipefail
python=/usr/bin/python3 programs=()
found() {  # found NAME PACKAGE COMMAND...
  if "${@:3}" >/dev/null 2>&1; then
    programs+=("$1")
  else
    echo "skipped: no data: $2 is not installed"
  fi
}
found vtk python3-vtk9 "$python" -c 'import vtkmodules.vtkIOXML'
found networkx python3-networkx "$python" -c 'import networkx'
found graphviz graphviz dot -V
found assimp assimp-utils assimp version
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" "$(dirname "$0")/foreign_exports.py" "$1" "$folder" "${programs[@]}"
