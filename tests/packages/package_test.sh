#!/usr/bin/env bash
# What other projects get: an installed tree with public headers that stand alone, a package with components,
# a checkout that can be a folder of theirs, static or shared, and a plain configuration that is a Release.
#
#   package_test.sh SOURCE_FOLDER BUILD_FOLDER CXX
set -uo pipefail
source=$1 build=$2 cxx=$3

source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
quietly() { ! "$@"; }

cmake --install "$build" --prefix "$work/prefix" >/dev/null || exit 1
headers=("$work"/prefix/include/reeb/*.h)
check "6 to 20 headers, and no other file" test "${#headers[@]}" -ge 6 -a "${#headers[@]}" -le 20 \
  -a "$(find prefix/include -type f | wc -l)" -eq "${#headers[@]}"
check "the licence is installed" cmp "$source/LICENSE" prefix/share/doc/reeb/LICENSE
if [[ -e $build/web/viewer.html ]]; then
  check "the viewer is installed" cmp "$build/web/viewer.html" prefix/share/reeb/viewer.html
fi

# Alone, twice, without warnings, and with no header that is neither ours nor the compiler's and the system's.
compile() {
  printf '#include "reeb/%s"\n#include "reeb/%s"\n' "$1" "$1" >alone.cpp
  "$cxx" -std=c++20 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -fsyntax-only -I prefix/include -MD -MF deps alone.cpp &&
    grep -q "include/reeb/$1" deps && quietly grep -iE 'tbb|boost|zstd|eigen|fmt' deps
}
for header in "${headers[@]}"; do
  check "$(basename "$header") alone" compile "$(basename "$header")"
done

# Components: what one does not need is not looked for.
mkdir package
cat >package/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(package LANGUAGES CXX)
find_package(reeb ${WHAT})
message(STATUS "found: ${reeb_FOUND}; why not: ${reeb_NOT_FOUND_MESSAGE}; TBB: ${TBB_FOUND}; Boost: ${Boost_FOUND}")
if(TARGET reeb::compute)
  file(WRITE ${CMAKE_BINARY_DIR}/empty.cpp "")
  add_library(user ${CMAKE_BINARY_DIR}/empty.cpp)
endif()
END
found() {  # found COMPONENTS PATTERN
  cmake -S package -B package/build -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$cxx" -DWHAT="$1" 2>&1 | tee found.log
  grep -qE "$2" found.log
}
check "all components" found "" 'found: (1|TRUE); why not: ; TBB: (1|TRUE); Boost: (1|TRUE)'
check "COMPONENTS reeb" found "COMPONENTS;reeb" 'found: (1|TRUE); why not: ; TBB: ; Boost: $'
check "COMPONENTS io" found "COMPONENTS;reeb;io" 'found: (1|TRUE); why not: ; TBB: ; Boost: (1|TRUE)'
check "COMPONENTS compute" found "COMPONENTS;compute" 'found: (1|TRUE); why not: ; TBB: (1|TRUE)'
check "COMPONENTS cellar" found "COMPONENTS;reeb;cellar" 'found: (0|FALSE); why not: reeb has no component cellar; it has reeb file io ooc compute;'
check "OPTIONAL_COMPONENTS cellar" found "COMPONENTS;reeb;OPTIONAL_COMPONENTS;cellar" 'found: (1|TRUE)'

# Without CMake.
check "pkg-config" by_pkg_config "$cxx" "$work/prefix/lib/pkgconfig:$(echo "$work"/prefix/lib/*/pkgconfig)"

# A plain configuration.
plain() { cmake -S "$source" -B plain -DCMAKE_CXX_COMPILER="$cxx" | tee plain.log && grep -q 'Release build' plain.log && grep -q 'CMAKE_BUILD_TYPE:STRING=Release' plain/CMakeCache.txt; }
unset CMAKE_BUILD_TYPE
check "a plain configuration is a Release and says so" plain

# The compiler of an MPI without its headers, as packages of other programs bring it, is no MPI.
mkdir half
cat >half/mpicxx <<'END'
#!/bin/sh
case "$*" in *-show*) echo "-I/nonexistent/mpi/include" ;; *) exit 1 ;; esac
END
chmod +x half/mpicxx
cp half/mpicxx half/mpic++
half_an_mpi() {
  PATH="$work/half:$PATH" cmake -S "$source" -B half/build -DCMAKE_CXX_COMPILER="$cxx" | tee half.log &&
    grep -q 'has no mpi.h, so there is no reeb-mpi' half.log
}
check "an MPI without headers" half_an_mpi

# A header that is public includes a private one: that is seen.
mkdir -p broken/libreeb/base
cat >broken/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.25)
project(broken LANGUAGES NONE)
include("$source/cmake/ReebPublicHeaders.cmake")
set(reeb_public_headers error)
set(reeb_public_error libreeb/base/error.h)
reeb_make_public_headers("\${CMAKE_CURRENT_SOURCE_DIR}" "\${CMAKE_BINARY_DIR}/include")
END
accepted() { printf '// A header.\n#pragma once\n\n#include %s\n' "$1" >broken/libreeb/base/error.h; cmake -S broken -B broken/build; }
refused() { accepted "$1" >broken.log 2>&1 && return 1; tr -s ' \n' ' ' <broken.log | grep -q 'neither public'; }
check "a public header may use the standard library" accepted "<vector>"
for include in '"libreeb/sweep/chunk.h"' '<tbb/tbb.h>' '<zstd.h>' '<unistd.h>'; do
  check "a public header may not include $include" refused "$include"
done

# A folder of another project: no tests, no benches, nothing that only these and the program need.
mkdir parent
cat >parent/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.25)
project(parent LANGUAGES CXX)
foreach(package GTest benchmark CLI11 fmt nlohmann_json)
  set(CMAKE_DISABLE_FIND_PACKAGE_\${package} ON)
endforeach()
add_subdirectory("$source" reeb)
add_executable(user user.cpp)
target_link_libraries(user reeb::reeb)
add_executable(whole whole.cpp)
target_link_libraries(whole reeb::compute)
END
cat >parent/user.cpp <<'END'
#include "reeb/online.h"
int main() {
  reeb::OnlineReeb online;
  online.add_simplex({{online.add_vertex(0), online.add_vertex(1)}});
  return online.snapshot().arc_count() == 1 ? 0 : 1;
}
END
printf '#include "reeb/reeb.h"\nint main() {}\n' >parent/whole.cpp
# Its headers are in its build folder; ours, the private ones, are not in reach.
private_headers_are_hidden() {
  grep '"command": .*user\.cpp' parent/build/compile_commands.json >of_user &&
    quietly grep -E "[-]I *$source( |\$)" of_user
}
no_tests_and_no_benches() {
  find parent/build -path '*/CMakeFiles/Makefile2' -o -name build.ninja | xargs -r cat >rules
  grep -q user rules && quietly grep -E 'tests/CMakeFiles|bench/CMakeFiles' rules
}
user_uses_shared() { readelf -d parent/build/user | grep -q 'libreeb.so.0'; }
check "add_subdirectory, shared" cmake -S parent -B parent/build -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_CXX_FLAGS=-O0 \
  -DBUILD_SHARED_LIBS=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
check "add_subdirectory, built" cmake --build parent/build --target user -j 2
check "add_subdirectory, runs" parent/build/user
check "the shared library is used" user_uses_shared
check "private headers are out of reach" private_headers_are_hidden
check "no tests and no benches" no_tests_and_no_benches

exit $((failures > 0))
