#!/usr/bin/env bash
# The program when a run ends early: killed, interrupted, out of disk space. Checks what it says and leaves, and that
# --resume gives the same bytes as an undisturbed run.
#
#   resume_program_test.sh SOURCE_FOLDER REEB
set -euo pipefail

source=$(realpath "$1")
reeb=$(realpath "$2")
folder=$(mktemp -d "${TMPDIR:-/tmp}/resume-test-XXXXXX")
mounted=
cleanup() {
  [[ -z $mounted ]] || umount "$mounted"
  rm -rf "$folder"
}
trap cleanup EXIT
cd "$folder"
unset TMPDIR

failed=0
check() { # what, then a command that must succeed
  local what=$1
  shift
  if "$@"; then echo "ok: $what"; else echo "FAILED: $what: $*"; cat messages; failed=1; fi
}
says() { grep -q -- "$1" messages; }
says_not() { ! grep -q -- "$1" messages; }
only() { # these and nothing else are in the folder $1
  local where=$1
  shift
  diff <(printf '%s\n' "$@" | sort) <(ls -A "$where" | sort)
}

"$reeb" generate scan --triangles 600k --seed 7 -o mesh.ply 2>messages
compute=("$reeb" compute "$folder/mesh.ply" -f random:1 --graph-only --memory 64M --chunk 10000)
"${compute[@]}" -o whole.reeb --quiet
export REEB_CHECKPOINT_SECONDS=0

# Starts a run and waits until it has made a checkpoint.
start() {
  "${compute[@]}" "$@" >messages 2>&1 &
  process=$!
  until [[ -e out.reeb.partial/checkpoint ]] || ! kill -0 "$process" 2>/dev/null; do sleep 0.01; done
}
# Runs to the end; sets $code to the exit code.
run() { code=0; "${compute[@]}" "$@" >messages 2>&1 || code=$?; }

for signal in INT TERM HUP; do
  start -o out.reeb
  kill -"$signal" "$process"
  code=0
  wait "$process" || code=$?
  check "SIG$signal ends a run with 130" test "$code" = 130
  check "it says how to resume" says "--resume continues"
  check "it leaves a folder" only . mesh.ply whole.reeb messages out.reeb.partial
  sum=$(md5sum <out.reeb.partial/checkpoint)
  run -o out.reeb
  check "the same command again is refused" test "$code" = 1
  check "it names both ways" says "continue it with --resume, or discard it with --force"
  check "nothing is touched" test "$sum" = "$(md5sum <out.reeb.partial/checkpoint)"
  run -o out.reeb --resume
  check "it continues" says "continues from there"
  check "with the same bytes" cmp whole.reeb out.reeb
  check "and leaves nothing else" only . mesh.ply whole.reeb messages out.reeb
  rm out.reeb
done

start -o out.reeb
run -o out.reeb
check "two runs to one output are refused" test "$code" = 3
check "by name" says "another run"
kill -KILL "$process"
wait "$process" 2>/dev/null || true
: >out.reeb.partial-999999-0
: >out.reeb.partial-notes
run -o out.reeb --force
check "a run with --force starts from the beginning" says_not "continues from there"
check "and clears up" only . mesh.ply whole.reeb messages out.reeb out.reeb.partial-notes
check "with the same bytes" cmp whole.reeb out.reeb
rm out.reeb out.reeb.partial-notes

run -o out.reeb --resume
check "without a checkpoint --resume starts from the beginning" says "nothing to resume"
rm out.reeb
code=0
"$reeb" compute - -o out.reeb --resume <mesh.ply >messages 2>&1 || code=$?
check "a stream is computed despite --resume" test "$code" = 0
check "with a note" says "cannot be resumed"
rm out.reeb

# Limits the size of files, in KiB. The first limit is too small for any checkpoint.
for limit in 16 1200; do
  code=0
  (ulimit -f "$limit" && exec "${compute[@]}" -o out.reeb) >messages 2>&1 || code=$?
  check "files of at most $limit KiB are too small: 3" test "$code" = 3
  check "in clear text" says "File too large"
  if [[ $limit == 16 ]]; then
    check "nothing to resume is promised" says_not "--resume"
    check "nothing is left" only . mesh.ply whole.reeb messages
  else
    check "it says how to resume" says "--resume continues"
    check "the folder is left" only . mesh.ply whole.reeb messages out.reeb.partial
  fi
  run -o out.reeb --resume
  check "resumed with larger files: same bytes" cmp whole.reeb out.reeb
  rm out.reeb
done

mkdir small
if [[ $EUID == 0 ]] && mount -t tmpfs -o size=1500k none small 2>messages; then
  mounted=$folder/small
  run -o small/out.reeb
  check "a full disk: 3" test "$code" = 3
  check "in clear text" says "No space left"
  check "it says how to resume" says "--resume continues"
  check "the folder is left" only small out.reeb.partial
  mount -o remount,size=64m "$folder/small"
  run -o small/out.reeb --resume
  check "it continues after space is made" says "continues from there"
  check "with the same bytes" cmp whole.reeb small/out.reeb
  check "and leaves nothing else" only small out.reeb
else
  echo "skipped: a full disk needs root and mount"
fi

# A mesh that is read only once, and a folder for temporary files that is too small for it.
"$reeb" convert mesh.ply mesh.obj 2>messages
rm -rf full && mkdir full
if [[ -n $mounted ]]; then
  umount "$mounted"
  mounted=
  mount -t tmpfs -o size=1500k none full
  mounted=$folder/full
  code=0
  "$reeb" compute mesh.obj -f random:1 --memory 16M --denoise 1% --temp-dir full -o out.reeb >messages 2>&1 || code=$?
  check "a full temporary folder: 3" test "$code" = 3
  check "in clear text" says "No space left"
  check "another folder is proposed" says "temp-dir"
  check "nothing is left in it" test -z "$(ls -A full)"
  check "nor elsewhere" only . mesh.ply mesh.obj whole.reeb messages small full
  umount "$mounted"
  mounted=
fi
rm -rf mesh.obj full

touch plain
for place in missing plain; do
  run -o out.reeb --temp-dir "$place"
  check "--temp-dir $place: 3" test "$code" = 3
  check "in clear text" says "temp-dir"
  run -o "$place/out.reeb"
  check "an output in $place: 3" test "$code" = 3
  check "the output's folder is named" says "$place: the output cannot be written to this folder"
  check "not that of temporary files" says_not "temp-dir"
done
check "nothing is left" only . mesh.ply whole.reeb messages plain small

check "killed at random moments" "$source/bench/kill_and_resume.sh" "$reeb" 8 600k "$folder"
exit "$failed"
