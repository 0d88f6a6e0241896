#!/usr/bin/env bash
# The types of tools/viewer, by the TypeScript compiler. Esbuild, which makes the page, only drops them.
#
#   types_test.sh SOURCE_FOLDER FOLDER     FOLDER keeps the npm packages, also those for development
set -euo pipefail
source=$1 folder=$2
node=$source/tests/web/node.sh

mkdir -p "$folder"
lock=$source/tools/web/package-lock.json
if ! cmp --silent "$lock" "$folder/installed.json"; then
  cp "$source/tools/web/package.json" "$lock" "$folder"
  if ! (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error) >/dev/null; then
    echo "skipped: not here: the npm packages for development cannot be installed"
    exit 0
  fi
  cp "$lock" "$folder/installed.json"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$source/tools/viewer" "$source/tools/web" "$source/tests/web/tsconfig.json" "$work"
ln -s "$(realpath "$folder")/node_modules" "$work/node_modules"
cd "$work"
"$node" node_modules/typescript/bin/tsc --project tsconfig.json
echo "ok: tsc finds nothing in tools/viewer"
