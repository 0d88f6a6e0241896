#!/usr/bin/env bash
# The Debian packages of a build folder, which this packs without compiling: their files, what they depend on, and the
# program and the Python module from them, unpacked into a folder.
#
#   deb_test.sh BUILD_FOLDER         as above
#   deb_test.sh BUILD_FOLDER root    also: lintian, and apt installs them in a new root of Debian 12, which mmdebstrap
#                                    fetches from the network; needs root. Minutes.
set -uo pipefail
build=$1 more=${2:-}
for tool in cpack dpkg-deb dpkg-shlibdeps; do
  command -v "$tool" >/dev/null || { echo "skipped: not here: $tool is not installed"; exit 0; }
done
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
chmod 755 "$work"

# Packed fast: how small they are is not tested. The folder names what is in it, so each test has its own.
pack=()
[[ $more == root ]] || pack=(-D CPACK_DEBIAN_COMPRESSION_TYPE=gzip)
(umask 022 && cpack --config "$build/CPackConfig.cmake" -B "$work/out" "${pack[@]}") >pack.log 2>&1 || { cat pack.log; exit 1; }
packages=$(cd out && for file in *.deb; do echo "${file%%_*}"; done | tr '\n' ' ')
expected="libreeb-dev reeb "
if compgen -G "$build/python/reeb/_reeb*.so" >/dev/null; then expected="libreeb-dev python3-reeb reeb "; fi
check "the packages: $packages" test "$packages" = "$expected"

has() {  # has PACKAGE PATH...: each is one file or more
  local package=$1 path
  shift
  dpkg-deb -c out/"$package"_*.deb | awk '$1 !~ /^d/ { print $6 }' >files
  for path in "$@"; do grep -qE "^\./usr/$path\$" files || { echo "no $path in:"; cat files; return 1; }; done
}
docs() { echo "share/doc/$1/copyright" "share/doc/$1/changelog.gz"; }
depends() {  # depends PACKAGE NAME...
  local package=$1 name
  shift
  dpkg-deb -f out/"$package"_*.deb Depends | tee depends
  for name in "$@"; do grep -qE "(^|[ ,|])$name([ ,:(]|\$)" depends || { echo "not on $name"; return 1; }; done
}
rooted() { dpkg-deb -c "$1" >listed && test -s listed && ! grep -v 'root/root' listed; }
check "files of reeb" has reeb bin/reeb share/man/man1/reeb.1.gz share/man/man1/reeb-compute.1.gz \
  share/bash-completion/completions/reeb share/zsh/vendor-completions/_reeb share/fish/vendor_completions.d/reeb.fish \
  $(docs reeb)
check "files of libreeb-dev" has libreeb-dev include/reeb/reeb.h 'lib/.*libreeb\.a' 'lib/.*libreeb_compute\.a' \
  'lib/.*pkgconfig/reeb\.pc' 'lib/.*cmake/reeb/reebConfig\.cmake' $(docs libreeb-dev)
check "what reeb depends on" depends reeb libc6 libzstd1 zlib1g libpng16-16 libexpat1 'libtbb[0-9]+'
check "what libreeb-dev depends on" depends libreeb-dev libzstd-dev liblz4-dev zlib1g-dev libpng-dev libexpat1-dev \
  libtbb-dev libboost-iostreams-dev
if [[ $expected == *python3* ]]; then
  check "files of python3-reeb" has python3-reeb 'lib/python3/dist-packages/reeb/_reeb.*\.so' \
    lib/python3/dist-packages/reeb/__init__.py lib/python3/dist-packages/reeb/py.typed $(docs python3-reeb)
  check "what python3-reeb depends on" depends python3-reeb libc6 python3 python3-numpy libzstd1
fi
for file in out/*.deb; do check "owners in $(basename "$file")" rooted "$file"; done

cat >use.sh <<'END'
# use.sh PREFIX FOLDER: what a user does first.
set -e
export PATH=$1/bin:$PATH PYTHONPATH=$1/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1
if [ "$1" = /usr ]; then unset PYTHONPATH; fi
cd "$2"
[ "$(command -v reeb)" = "$1/bin/reeb" ]
reeb --version
reeb generate torus --triangles 2000 -o torus.ply
reeb compute torus.ply -f x -o torus.reeb
reeb info torus.reeb
[ "$(reeb extract torus.reeb --threshold 10% --format rg | grep -c '^a ')" -eq 4 ]
if [ -d "$1/lib/python3/dist-packages/reeb" ]; then
  /usr/bin/python3 -c '
import sys, reeb
assert reeb.__file__.startswith(sys.argv[1]), reeb.__file__
assert len(reeb.compute("torus.ply", f="x", output="own.reeb", force=True).level("10%").arcs) == 4' "$1"
fi
END
mkdir tree
for file in out/*.deb; do dpkg-deb -x "$file" tree; done
check "the program and the module, unpacked" bash use.sh "$work/tree/usr" "$work"
check "the library, unpacked" by_pkg_config c++ "$(dirname "$(find tree -name reeb.pc)")"

if [[ $more == root ]]; then
  # The library is in lib, as in any other prefix; its packages are not for cross-compilation.
  check "lintian" lintian --allow-root --fail-on error,warning --suppress-tags pkg-config-unavailable-for-cross-compilation out/*.deb
  [[ ! -s log ]] || cat log
  fetched() { mmdebstrap --variant=apt bookworm root; }
  check "a new root" fetched
  mkdir -p root/packages
  cp out/*.deb use.sh root/packages
  cp /etc/resolv.conf root/etc
  check "its lists" chroot root apt-get update
  installed() { (cd root && chroot . env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends ./packages/*.deb); }
  used() { chroot root sh /packages/use.sh /usr /tmp; }
  removed() { chroot root env DEBIAN_FRONTEND=noninteractive apt-get remove -y $packages && ! find root/usr -name '*reeb*' ! -name '*freebsd*' | grep .; }
  SECONDS=0
  check "apt installs them" installed
  echo "in $SECONDS s"
  check "the program and the module, installed" used
  [[ ! -s log ]] || cat log
  check "nothing is left of them" removed
fi
exit $((failures > 0))
