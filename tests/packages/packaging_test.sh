#!/usr/bin/env bash
# What comes with an installation: man pages, completions, files for package managers.
#
#   packaging_test.sh SOURCE_FOLDER REEB
set -uo pipefail
source=$1 reeb=$2
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
have() { command -v "$1" >/dev/null || { echo "skipped: not here: $1 is not installed"; false; }; }

bash "$source/packaging/from_help.sh" "$reeb" 1.2.3 "$work/help" || exit 1
commands=$("$reeb" --help | awk '/^Commands:/ { on = 1; next } /^[^ ]/ { on = 0 } on && NF { print $1 }')
check "a man page each" test "$(ls help/man | wc -l)" -eq $((1 + $(wc -w <<<"$commands")))
if have man; then
  renders() { LC_ALL=C.UTF-8 MANROFFSEQ='' man --warnings -E UTF-8 -l -Tutf8 -Z "$1" 2>&1 >/dev/null | tee warnings; test ! -s warnings; }
  for page in help/man/*.1; do check "$(basename "$page")" renders "$page"; done
fi
# Every option of --help is in the page, and in each completion.
everything() {
  local command option page of_bash of_fish of_zsh options=0
  of_zsh=$(<help/_reeb)
  for command in $commands; do
    page=$(<"help/man/reeb-$command.1") of_bash=$(grep -F " $command) " help/reeb.bash)
    of_fish=$(grep -F "from $command'" help/reeb.fish)
    for option in $("$reeb" "$command" --help | grep -oE '^  (-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
      [[ $page == *"${option//-/\\-}"* ]] || { echo "page of $command: $option"; return 1; }
      [[ $of_bash == *[\ \']"$option "* ]] || { echo "bash: $command $option"; return 1; }
      [[ $of_fish == *" -l ${option#--} "* ]] || { echo "fish: $command $option"; return 1; }
      [[ $of_zsh == *"'*$option["* ]] || { echo "zsh: $option"; return 1; }
      options=$((options + 1))
    done
  done
  test "$options" -ge 100 || { echo "only $options options were found"; return 1; }
}
check "every option" everything

bash_says() {  # bash_says EXPECTED WORD...
  local expected=$1
  shift
  bash -c 'source help/reeb.bash; COMP_WORDS=(reeb "$@"); COMP_CWORD=$#; _reeb; printf "%s\n" "${COMPREPLY[@]}" | sort | tr "\n" " "' \
    bash "$@" >said
  [[ $(<said) == "$expected " ]] || { echo "said: $(<said)"; return 1; }
}
touch mesh.ply
check "bash: commands" bash_says "extract" ext
check "bash: options" bash_says "--threads --threshold" extract x.reeb --thr
check "bash: files" bash_says "mesh.ply" info mesh
check "bash: a mesh without a command" bash_says "--denoise" mesh.ply --den
check "bash: values that are no files" bash_says "" compute --memory m
check "bash: values that are files" bash_says "mesh.ply" compute -o m
# A bash at a terminal, where tab is typed.
cat >type.py <<'END'
import os, pty, select, sys, time

words, expected = sys.argv[1:]
child, terminal = pty.fork()
if child == 0:
    os.environ.update(TERM="dumb", PS1="$ ", INPUTRC="/dev/null", HISTFILE="")
    os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])
os.write(terminal, b"source help/reeb.bash; echo set-$((6 * 7))\n")
said, asked, end = b"", False, time.monotonic() + 20
while time.monotonic() < end:
    if select.select([terminal], [], [], 0.1)[0]:
        said += os.read(terminal, 4096)
    if not asked and b"set-42" in said:
        os.write(terminal, words.encode() + b"\t")
        said, asked = b"", True
    if asked and expected.encode() in said:
        sys.exit(0)
sys.exit(f"said: {said!r}")
END
check "bash at a terminal: commands" /usr/bin/python3 type.py "reeb ext" "reeb extract "
check "bash at a terminal: options" /usr/bin/python3 type.py "reeb extract --thres" "--threshold "
if have zsh; then
  cat >type.zsh <<'END'
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PS1=ready; fpath=($PWD/help \$fpath); autoload -Uz compinit; compinit -u -d $PWD/dump; print -r set-up"
until zpty -r shell piece && [[ $piece == set-up* ]]; do :; done
zpty -w -n shell $1$'\t'
end=$((SECONDS + 20))
while ((SECONDS < end)); do
  if zpty -r -t shell piece; then out+=$piece; else sleep 0.1; fi
  if [[ $out == *$2* ]]; then exit 0; fi
done
print -r -- "$out"
exit 1
END
  check "zsh: commands" timeout 60 zsh -f type.zsh "reeb ext" "act"
  check "zsh: options" timeout 60 zsh -f type.zsh "reeb extract --thres" "hold"
fi
if have fish; then
  fish_says() { HOME=$work fish -c "source help/reeb.fish; complete -C '$1'" | cut -f1 | sort | tr '\n' ' ' >said; [[ $(<said) == "$2 " ]] || { cat said; return 1; }; }
  check "fish: commands" fish_says "reeb ext" "extract"
  check "fish: options" fish_says "reeb extract --thr" "--threads --threshold"
fi

packaging=$source/packaging
check "vcpkg.json" /usr/bin/python3 -m json.tool "$packaging/vcpkg/vcpkg.json"
check "portfile.cmake" grep -q vcpkg_cmake_install "$packaging/vcpkg/portfile.cmake"
check "package.py" /usr/bin/python3 -c "import ast; ast.parse(open('$packaging/spack/package.py').read())"
version=$(sed -n 's/^project(reeb VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
for file in vcpkg/vcpkg.json conda/meta.yaml homebrew/reeb.rb spack/package.py; do
  check "$file has the version" grep -qF "\"$version\"" "$packaging/$file"
done
if have ruby; then check "reeb.rb" ruby -c "$packaging/homebrew/reeb.rb"; fi
exit $((failures > 0))
