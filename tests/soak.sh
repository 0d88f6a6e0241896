#!/usr/bin/env bash
# Many random meshes in one process: memory and open files must stay flat.
#
#   tests/soak.sh [N]
#
# Computes, resumes, verifies, extracts and converts N meshes (1,000), and prints what the process holds after a tenth,
# half and all of them. REEB_SEED=S takes other meshes. About 15 ms for each mesh.
set -euo pipefail
cd "$(dirname "$0")/.."
count=${1:-1000}
[[ $count =~ ^[1-9][0-9]*$ ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$0" >&2; exit 2; }

mkdir -p build/release
cmake --preset release >build/release/configure-log.txt
cmake --build --preset release --target soak_test
REEB_CASES=$count build/release/tests/soak_test
