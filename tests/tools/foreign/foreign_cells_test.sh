#!/usr/bin/env bash
# Cell files that VTK and meshio write, as far as they are installed for Debian's Python: foreign_cells.py.
#
#   foreign_cells_test.sh REEB
set -euo pipefail
python=/usr/bin/python3 libraries=()
if "$python" -c 'import vtkmodules.vtkIOXML' 2>/dev/null; then
  libraries+=(vtk)
else
  echo "skipped: not here: python3-vtk9 is not installed"
fi
if "$python" -c 'import meshio' 2>/dev/null; then
  libraries+=(meshio)
else
  echo "skipped: not here: python3-meshio is not installed"
fi
[[ ${#libraries[@]} -gt 0 ]] || exit 0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" "$(dirname "$0")/foreign_cells.py" "$1" "$folder" "${libraries[@]}"
