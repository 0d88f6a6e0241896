#!/usr/bin/env bash
# Instructions and memory of fixed small runs, against those recorded in costs.json: costs.py has its help.
#
#   cost_test.sh REEB COMPILER
set -euo pipefail
if ! command -v valgrind >/dev/null; then
  echo "skipped: valgrind is not installed; tools/install_packages.sh tests installs it"
  exit 0
fi
exec python3 "$(dirname "$0")/costs.py" "$1" --compiler "$2"
