#!/usr/bin/env bash
# Kills runs at random moments, resumes them with --resume, and compares the bytes of the results with
# those of an uninterrupted run.
#
#   bench/kill_and_resume.sh REEB [MOMENTS [TRIANGLES [FOLDER]]]
#
# REEB is the program; 50 moments, 4M triangles and a folder under $TMPDIR by default.
# In turn the mesh is looked up in place (binary PLY), read once with guesses (OBJ), and a stream with
# finalization (SMC), without and with noise removal; all with an embedding.
# A run makes a checkpoint after every chunk, and is killed once or several times before it may end.
# SEED=N repeats a run of this script. Prints one line per moment; the exit code is 0 only if all
# results were the same, no other file was left, and at least one run continued from a checkpoint.
set -euo pipefail

case ${1:-} in
  '' | -h | --help) sed -n '2,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
reeb=$(realpath "$1")
moments=${2:-50}
triangles=${3:-4M}
folder=$(mktemp -d "${4:-${TMPDIR:-/tmp}}/kill-and-resume-XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"

RANDOM=${SEED:=$(date +%N | sed 's/^0*//')}
echo "seed $SEED"
export REEB_CHECKPOINT_SECONDS=0
"$reeb" generate scan --triangles "$triangles" --seed 7 -o mesh.ply
"$reeb" convert mesh.ply mesh.obj
"$reeb" convert mesh.ply mesh.smc --finalize
runs=("mesh.ply" "mesh.obj" "mesh.smc" "mesh.ply --denoise 20%" "mesh.obj --denoise 20%" "mesh.smc --denoise 20%")

# Small chunks and little memory: many checkpoints, and segments on disk.
compute() {
  # shellcheck disable=SC2086  # the run's words
  exec "$reeb" compute ${runs[run]} -f random:1 --graph-only --memory 64M --chunk 20000 "$@"
}

declare -a spans
for run in "${!runs[@]}"; do
  begin=$(date +%s%N)
  (compute -o "whole-$run.reeb" --quiet)
  spans[run]=$((($(date +%s%N) - begin) / 1000000))
  echo "${runs[run]}, left alone: ${spans[run]} ms"
done
ls >there

# Starts a run to the output $1 with the options that follow, and kills it after a random time.
run_and_kill() {
  local output=$1 moment=$((RANDOM * spans[run] / 32768))
  shift
  (compute -o "$output" --quiet "$@" 2>messages) &
  local process=$!
  sleep "$(printf '%d.%03d' $((moment / 1000)) $((moment % 1000)))"
  # Killing fails if the run has already ended.
  kill -KILL "$process" 2>/dev/null || true
  wait "$process" 2>/dev/null || true
  printf ' %d ms' "$moment"
}

failed=0 resumed=0
for ((i = 1; i <= moments; ++i)); do
  output=killed.reeb
  run=$((i % ${#runs[@]}))
  printf 'moment %d, %s: killed after' "$i" "${runs[run]}"
  run_and_kill "$output"
  for ((again = RANDOM % 3; again > 0; --again)); do
    [[ -e $output ]] || run_and_kill "$output" --resume
  done
  left=$(find . -mindepth 1 -maxdepth 1 ! -name messages ! -name there ! -name "$output" ! -name "$output.partial" \
    ! -name "$output.partial-*" -printf '%f\n' | grep -cvxFf there || true)
  kept="no checkpoint"
  [[ -e $output.partial/checkpoint ]] && kept="a checkpoint"
  [[ -e $output ]] && kept="the whole output"
  # A run that is killed when its output is whole might not have removed its folder: the next run of that name does.
  [[ -e $output && -e $output.partial ]] && (compute -o "$output" --quiet --force)
  if [[ ! -e $output ]]; then
    (compute -o "$output" --resume >messages 2>&1) || { cat messages; exit 1; }
    # A note says so, in one line or two.
    if tr -s ' \n' ' ' <messages | grep -q "this one continues from there"; then resumed=$((resumed + 1)); fi
  fi
  if cmp -s "whole-$run.reeb" "$output" && [[ $left == 0 && -z $(find . -name '*.partial*') ]]; then
    echo "; it left $kept: same bytes"
  else
    echo "; it left $kept: FAILED"
    failed=$((failed + 1))
    find . | sort
  fi
  rm -rf "$output" "$output".partial*
done
echo "$((moments - failed)) of $moments the same; $resumed continued from a checkpoint"
[[ $failed == 0 && $resumed -gt 0 ]]
