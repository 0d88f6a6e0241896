#!/usr/bin/env bash
# Measures reeb and writes docs/BENCHMARKS.md, its picture, and docs/benchmarks.json: one command, asks nothing.
#
#   bench/run.sh [--quick | --full | --huge] [OPTION...]
#
#   --quick            meshes up to 12 million triangles, less than 3 minutes on a quiet machine (default)
#   --full             also 28 and 56 million, less than 30 minutes; 5 GB of disk
#   --huge             also 372 million; 30 GB of disk
#   --only TABLE,...   these tables: sizes orders extras manifold peers targets profile
#   --folder DIR       where meshes and figures are kept (default: build/bench)
#   --program FILE     measure this program; without it, the release build is brought up to date and measured
#   --runs N           runs of each command (default: 3; those of 28 million and more: 1 less)
#   --again            measure what is stored, too
#   --render           write the documents from docs/benchmarks.json; builds and runs nothing
#   --output DIR       write the documents there (default: docs)
#
# Answers are checked before anything is timed. Each figure is stored in DIR/cells as soon as it is there, so the same
# command resumes an interrupted run, and a larger mode keeps the figures of a smaller one. Figures of another program
# are measured again. A command that fails or takes too long is reported, and the rest goes on; the exit code is 1 then.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/.."

build=1
for word in "$@"; do
  case $word in
    -h | --help) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//p}' "$0"; exit 0 ;;
    --render | --program) build= ;;
  esac
done
if [[ -n $build ]]; then
  tools/install_packages.sh time
  mkdir -p build
  cmake --preset release >build/bench-build.txt 2>&1 || { cat build/bench-build.txt >&2; exit 1; }
  echo "building" >&2
  cmake --build --preset release --target reeb_program reader_bench >build/bench-build.txt 2>&1 ||
    { tail -40 build/bench-build.txt >&2; exit 1; }
fi
# The system's Python sees VTK of Debian.
python=/usr/bin/python3
[[ -x $python ]] || python=python3
exec "$python" bench/tables/run.py "$@"
