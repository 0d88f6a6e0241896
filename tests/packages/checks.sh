# What test scripts begin with: an empty working folder $work, removed at the end, and checks. A script ends with
# `exit $((failures > 0))`.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
check() {  # check WHAT COMMAND...: the command succeeds
  local what=$1
  shift
  if "$@" >log 2>&1; then echo "ok: $what"; else echo "FAILED: $what"; cat log; failures=$((failures + 1)); fi
}
