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
differing=$(find "${folders[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
  xargs -0 -n 20 -P "$(nproc)" sh -c '
    for file; do clang-format-14 --dry-run -Werror "$file" 2>/dev/null || echo "$file"; done' sh)
[[ -n $differing ]] || exit 0
echo "These files are not formatted; this formats them:"
echo "  clang-format-14 -i" $differing
exit 1
