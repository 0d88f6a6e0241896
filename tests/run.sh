#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#
#   tests/run.sh [--preset release|asan|tsan|dev] [--label LABEL] [--only NAME,NAME...]
#                [--all | --sanitize] [--no-skips]
#
# Runs all tests of the preset (release), or those with the ctest label; --only builds and runs the
# programs of these names (soak_test). --all runs the release tests, and with sanitizers those that find
# something there: the labels asan and tsan with their presets. --sanitize runs every test with both
# presets, asan (with undefined behaviour) and tsan, in an hour or more. REEB_CASES=N sets how many
# random cases the model tests try, REEB_MOST_CASES=N the most that any does: with --sanitize 100.
#
# What is skipped is printed with its reason. The last line is `N passed, N failed, N skipped`. It counts
# test cases (TEST and TEST_P of GoogleTest; a script is one case), each as often as ctest runs it.
# The exit code is 0 only if nothing failed. With --no-skips a skip fails, too, unless its reason begins with
#   no data:    real meshes, where REEB_DATA is not set and ../shared/data/meshes does not exist
#   not here:   a program, a package or a right that this machine lacks and that this script does not install;
#               a part that this build is with or without; costs that were recorded on another machine
# A test of several reasons counts under the worst.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; }
runs=()  # PRESET:LABEL
preset=release label= names= no_skips=
while [[ $# -gt 0 ]]; do
  case $1 in
    --preset | --label | --only)
      [[ $# -ge 2 ]] || { echo "error: $1 needs a value" >&2; exit 2; }
      case $1 in --preset) preset=$2 ;; --label) label=$2 ;; --only) names=$2 ;; esac
      shift 2 ;;
    --sanitize) runs=(asan: tsan:); export REEB_MOST_CASES=${REEB_MOST_CASES:-100}; shift ;;
    --all) runs=(release: asan:asan tsan:tsan); shift ;;
    --no-skips) no_skips=1; shift ;;
    -h | --help) usage; exit 0 ;;
    *) echo "error: unknown option $1; see $0 --help" >&2; exit 2 ;;
  esac
done
case $preset in
  release | asan | tsan | dev) ;;
  *) echo "error: no preset $preset; there are release, asan, tsan and dev" >&2; exit 2 ;;
esac
[[ ${#runs[@]} -gt 0 ]] || runs=("$preset:$label")

jobs=$(nproc)
step() { printf '== %s (%d s)\n' "$1" "$SECONDS"; }
passed=0 failed=0 no_data=0 not_here=0 other_skips=0

# count FOLDER LOG: adds what ctest and the programs said of their cases, and prints the skips.
count() {
  local name status xml cases failures skips reasons reason
  # ctest's own lines: " 3/70 Test #12: name ......   Passed    0.10 sec"
  while read -r name status; do
    xml=$1/$name.xml
    if [[ -s $xml ]]; then
      cases=$(grep -c '<testcase .*status="run"' "$xml") || true
      failures=$(sed -n 's/^<testsuites .*failures="\([0-9]*\)".*errors="\([0-9]*\)".*/\1/p' "$xml")
      # A program may fail with no case failed, as with a sanitizer's report.
      if [[ $status != Passed && $failures == 0 ]]; then failures=1 cases=$((cases + 1)); fi
      mapfile -t reasons < <(sed -n 's/.*<skipped message="\([^"]*\)".*/\1/p' "$xml" |
        sed 's/^[^&]*&#x0A;//; s/&#x0A;/ /g; s/&quot;/"/g; s/&lt;/</g; s/&gt;/>/g; s/&apos;/'"'"'/g; s/&amp;/\&/g')
      skips=${#reasons[@]}
      for reason in "${reasons[@]}"; do note_skip "$name" "$reason"; done
    else
      mapfile -t reasons < <(sed -n 's/^skipped: //p' "$1/$name.txt" 2>/dev/null)
      cases=1 failures=0 skips=0
      if [[ $status != Passed ]]; then
        failures=1
      elif [[ ${#reasons[@]} -gt 0 ]]; then
        skips=1
        note_skip "$name" "${reasons[@]}"
      fi
    fi
    passed=$((passed + cases - failures - skips)) failed=$((failed + failures))
  done < <(sed -n 's/^ *[0-9]*\/[0-9]* Test *#[0-9]*: \([^ ]*\) \.*\(\** *\)\([A-Za-z]*\).*/\1 \3/p' "$2")
}

note_skip() {  # TEST REASON...: one test case
  local reason kind=no_data
  for reason in "${@:2}"; do
    echo "skipped: $1: $reason"
    case $reason in
      "no data:"*) ;;
      "not here:"*) [[ $kind != no_data ]] || kind=not_here ;;
      *) kind=other_skips ;;
    esac
  done
  printf -v "$kind" %d $((${!kind} + 1))
}

run() {  # PRESET LABEL
  local folder=build/$1 options=() targets=(all) status=0
  if [[ -n $2 ]]; then options=(-L "^$2\$"); fi
  if [[ $1 == "$2" ]]; then targets=("$2_tests"); fi
  if [[ -n $names ]]; then
    options+=(-R "^(${names//,/|})\$")
    IFS=, read -ra targets <<<"$names"
  fi
  step "configure, preset $1"
  mkdir -p "$folder"
  # Debian's Python is the one for which the packages are installed.
  local python=OFF
  if [[ $1 == release ]]; then python=ON; fi
  cmake --preset "$1" -DREEB_WERROR=ON -DREEB_PYTHON="$python" -DPython3_EXECUTABLE=/usr/bin/python3 >"$folder/configure-log.txt" 2>&1 ||
    { cat "$folder/configure-log.txt"; exit 1; }
  step "build ${targets[*]} of preset $1 with $jobs jobs"
  NINJA_STATUS='[%f/%t] ' cmake --build --preset "$1" --target "${targets[@]}" -j "$jobs"
  step "test, preset $1"
  rm -rf "$folder/test-results"
  mkdir -p "$folder/test-results"
  ctest --preset "$1" -j "$jobs" --no-tests=error "${options[@]}" </dev/null 2>&1 |
    tee "$folder/test-log.txt" || status=$?
  local before=$failed
  count "$folder/test-results" "$folder/test-log.txt"
  if [[ $status != 0 && $failed == "$before" ]]; then failed=$((failed + 1)); fi
}

step "packages"
tools/install_packages.sh tests
for one in "${runs[@]}"; do run "${one%%:*}" "${one#*:}"; done
step "done"
skipped=$((no_data + not_here + other_skips))
if [[ $skipped -gt 0 ]]; then echo "skipped: $no_data no data, $not_here not here, $other_skips for other reasons"; fi
if [[ -n $no_skips && $other_skips -gt 0 ]]; then
  echo "skips for other reasons fail with --no-skips"
  failed=$((failed + other_skips)) skipped=$((skipped - other_skips))
fi
echo "$passed passed, $failed failed, $skipped skipped"
[[ $failed == 0 && $passed -gt 0 ]]
