#!/usr/bin/env bash
# Checks what the README shows. Installs the project into a temporary prefix, runs the commands of the ```console
# blocks, builds the programs against the installed package with the CMakeLists.txt of the README, and compares all
# output with the README.
#
#   readme_test.sh README.md BUILD_FOLDER [CXX_FLAGS]
set -euo pipefail
readme=$1 build=$2 flags=${3:-}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0

# Ignores lines with times, which differ from run to run.
same() {  # same WHAT EXPECTED ACTUAL
  if diff -u --label README --label "$1" <(grep -v 'triangles/s' "$2") <(grep -v 'triangles/s' "$3"); then
    echo "ok: $1"
  else
    failures=$((failures + 1))
  fi
}

# The N-th block of a language.
block() {
  awk -v open="\`\`\`$1" -v wanted="$2" '
    /^```/ && inside { inside = 0; next }
    $0 == open && ++seen == wanted { inside = 1; next }
    inside' "$readme"
}

cmake --install "$build" --prefix "$work/prefix" >install.log
PATH=$work/prefix/bin:$PATH

# Commands, each with its output.
{ block console 1; block console 2; } >console.txt
grep -q '^\$ ' console.txt || { echo "the README has no console block"; exit 1; }
while IFS= read -r line; do
  echo "$line"
  if [[ $line == '$ '* ]]; then eval "${line#\$ }" 2>&1 </dev/null; fi
done < <(grep '^\$ ' console.txt) >console.out
same "console blocks" console.txt console.out

# Programs, each followed by its output.
mkdir project
block cmake 1 >project/CMakeLists.txt
programs=0
while block cpp $((programs + 1)) >source.cpp && [[ -s source.cpp ]]; do
  programs=$((programs + 1))
  lines=$(grep -c . source.cpp)
  # The first line only names the file.
  [[ $((lines - 1)) -lt 15 ]] || { echo "program $programs has $((lines - 1)) lines"; failures=$((failures + 1)); }
  name=$(sed -n '1s,^// \(.*\)\.cpp$,\1,p' source.cpp)
  mv source.cpp "project/$name.cpp"
  block text "$programs" >"$name.expected"
done
[[ $programs -eq 4 ]] || { echo "the README has $programs programs, not 4"; exit 1; }
if grep -hE '#include "' project/*.cpp | grep -v '"reeb/'; then echo "the README includes private headers"; exit 1; fi
cmake -S project -B project/build -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_FLAGS="$flags" \
  -DCMAKE_CXX_COMPILER_LAUNCHER= >configure.log 2>&1 || { cat configure.log; exit 1; }
cmake --build project/build >build.log 2>&1 || { cat build.log; exit 1; }
for expected in *.expected; do
  name=${expected%.expected}
  project/build/"$name" >"$name.out" 2>&1 || { echo "$name exits with $?"; failures=$((failures + 1)); }
  same "$name.cpp" "$expected" "$name.out"
done

exit $((failures > 0))
