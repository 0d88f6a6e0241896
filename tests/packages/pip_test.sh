#!/usr/bin/env bash
# What `pip install .` installs, from a copy of the sources into a new venv, without the network: a wheel with what it
# should have and no more, which works. It compiles everything: minutes, unless CMAKE_CXX_COMPILER_LAUNCHER is a cache.
#
#   pip_test.sh SOURCE_FOLDER REEB PYTHON
set -uo pipefail
source=$1 reeb=$2 python=$3
"$python" -c 'import numpy, setuptools, wheel, venv, ensurepip' 2>/dev/null || { echo "skipped: not here: python3-venv or python3-setuptools is not installed"; exit 0; }
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
unset PYTHONPATH
export PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1
mkdir copy
(cd "$source" && git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$work/copy") || exit 1
check "a venv" "$python" -m venv --system-site-packages venv
cd copy
SECONDS=0
check "pip wheel" ../venv/bin/pip wheel --no-build-isolation --no-deps -w ../wheels .
echo "in $SECONDS s"
cd ..
files() { "$python" -m zipfile -l wheels/*.whl | awk 'NR > 1 { print $1 }' | sed -E 's/_reeb\..*\.so$/_reeb.so/; s/^reeb-[0-9.]*\.dist-info/info/' | sort; }
expected() {
  (cd copy/tools/python && ls reeb/*.py reeb/*.pyi reeb/py.typed)
  printf '%s\n' reeb/_reeb.so info/{LICENSE,METADATA,RECORD,WHEEL,top_level.txt}
}
no_more() { diff <(expected | sort) <(files); }
check "the wheel has the module, its sources and the licence" no_more
names_its_needs() { "$python" -m zipfile -e wheels/*.whl unpacked && grep -x 'Requires-Dist: numpy' unpacked/*.dist-info/METADATA; }
check "it needs numpy only" names_its_needs
installed() { venv/bin/pip install --no-deps wheels/*.whl; }
check "pip install" installed
used() {
  "$reeb" generate torus --triangles 2000 -o torus.ply && venv/bin/python -c '
import sys, reeb
assert reeb.__file__.startswith(sys.prefix), reeb.__file__
assert len(reeb.compute("torus.ply", f="x", memory="64M").level("10%").arcs) == 4'
}
check "it works" used
removed() { venv/bin/pip uninstall -y reeb && ! find venv -name '*reeb*' | grep .; }
check "nothing is left of it" removed
exit $((failures > 0))
