#!/usr/bin/env bash
# Installs the Debian packages that are missing, and says which. Does nothing if all are installed.
#
#   tools/install_packages.sh              for building the program
#   tools/install_packages.sh tests        also for the tests and benchmarks
#   tools/install_packages.sh PACKAGE...   also these
#
# Needs apt-get, and root or sudo only if something is missing. Never asks a question.
set -euo pipefail

packages=(cmake ninja-build g++ pkg-config libtbb-dev libzstd-dev liblz4-dev zlib1g-dev libpng-dev
          libexpat1-dev libboost-iostreams-dev libcli11-dev libfmt-dev nlohmann-json3-dev libfast-float-dev libxxhash-dev
          libeigen3-dev libspectra-dev)
# Node.js often comes from elsewhere; then packages of Debian would be in its way.
command -v node >/dev/null || command -v nodejs >/dev/null || packages+=(nodejs)
command -v npm >/dev/null || packages+=(npm)
test_packages=(libgtest-dev libbenchmark-dev zstd clang-format-14 python3-numpy gnuplot-nox graphviz librsvg2-bin
               libxml2-utils libopenmpi-dev openmpi-bin python3-distributed python3-dev pybind11-dev
               python3-pytest python3-networkx valgrind time)

for word in "$@"; do
  case $word in
    tests) packages+=("${test_packages[@]}") ;;
    -*) echo "usage: $0 [tests] [PACKAGE...]" >&2; exit 2 ;;
    *) packages+=("$word") ;;
  esac
done

is_installed() {
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

find_missing() {
  missing=()
  for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
  done
  [[ ${#missing[@]} -gt 0 ]]
}
find_missing || exit 0

if ! command -v apt-get >/dev/null; then
  echo "error: these Debian packages are missing, and there is no apt-get: ${missing[*]}" >&2
  exit 1
fi
as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "error: become root, or install sudo, to install: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

apt() {
  # Other programs, such as a daily upgrade, can hold apt's lock.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@" \
    </dev/null 9<&-
}

# Of two tests that ask at once, the second one waits, and finds what the first has installed.
exec 9</var/lib/dpkg
flock 9 || true
find_missing || exit 0

echo "installing Debian packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install() { apt install --yes --no-install-recommends "${missing[@]}" >"$log" 2>&1; }
# Package lists can be missing or old: fetch them only if the first attempt fails.
if ! install; then
  echo "fetching the package lists"
  # apt-get does not wait for the lock of the lists.
  apt update >"$log" 2>&1 || { sleep 20; apt update >"$log" 2>&1; } || { cat "$log" >&2; exit 1; }
  install || { cat "$log" >&2; exit 1; }
fi
