#!/usr/bin/env bash
# All sources are formatted as .clang-format says. Other versions of clang-format than 14 differ.
#
#   format_test.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"

if ! command -v clang-format-14 >/dev/null; then
  echo "skipped: clang-format-14 is not installed; tools/install_packages.sh tests installs it"
  exit 0
fi
folders=(libreeb io ooc tools tests bench)
# Many files for each process, since a start takes longer than a file.
if said=$(find "${folders[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
  xargs -0 -n 100 -P "$(nproc)" clang-format-14 --dry-run -Werror 2>&1); then
  exit 0
fi
differing=$(sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: error: code should be clang-formatted.*/\1/p' <<<"$said" | sort -u)
[[ -n $differing ]] || { echo "$said"; exit 1; }
echo "These files are not formatted; this formats them:"
echo "  clang-format-14 -i" $differing
exit 1
