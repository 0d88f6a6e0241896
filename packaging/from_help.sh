#!/usr/bin/env bash
# Makes man pages and completions of the program from what its --help says.
#
#   from_help.sh REEB VERSION OUT      writes OUT/man/*.1, OUT/reeb.bash, OUT/_reeb, OUT/reeb.fish
set -euo pipefail
reeb=$1 version=$2 out=$3
rm -rf "$out/man"
mkdir -p "$out/man"

# The items of a section of the help, one a line: term, tab, text. A term is in the first 27 columns, or alone on its line.
items() {  # items SECTION <help
  awk -v section="$1:" '
    function flush() { if (term != "") print term "\t" text; term = ""; text = "" }
    /^[^ ]/ { flush(); inside = $0 == section; next }
    !inside { next }
    /^  [^ ]/ {
      flush()
      apart = length($0) > 27 && substr($0, 27, 1) == " "
      term = apart ? substr($0, 3, 24) : substr($0, 3)
      text = apart ? substr($0, 28) : ""
      sub(/ Needs: [^ ]*( [^ ]*)*/, "", term)
      sub(/ \(required\)/, "", term)
      sub(/ +$/, "", term)
      next
    }
    /^ +[^ ]/ && term != "" { sub(/^ +/, ""); text = text (text == "" ? "" : " ") $0 }
    END { flush() }'
}

roff() { sed 's/\\/\\e/g; s/-/\\-/g; s/^\([.'"'"']\)/\\\&\1/'; }

# The lines after "Example:" or "Examples:".
examples() { awk 'inside && /^[^ ]/ { exit } inside && NF { sub(/^  /, ""); print } /^Examples?:/ { inside = 1 }'; }

# .TP entries of items on standard input.
tagged() { sed 's/\t/\n/' | roff | sed '1~2s/^/.TP\n.B /'; }

page() {  # page COMMAND: the man page; an empty COMMAND is the program
  local command=$1 help name title
  help=$("$reeb" $command --help)
  name=reeb${command:+-$command} title=${help%%$'\n'*}
  printf '.TH %s 1 "" "reeb %s" "User Commands"\n.SH NAME\n%s \\- %s\n' "${name^^}" "$version" "$(roff <<<"$name")" \
    "$(roff <<<"$title")"
  printf '.SH SYNOPSIS\n'
  sed -n 's/^Usage: //p; s/^       \(reeb [^ ]* \[OPTIONS\]\).*/.br\n\1/p' <<<"$help" | roff | sed 's/^\\&//; /^\.br/!s/^/.B /'
  local section
  for section in Arguments Options Commands; do
    if [[ $help == *$'\n'"$section:"* ]]; then
      printf '.SH %s\n' "${section^^}"
      items "$section" <<<"$help" | tagged
    fi
  done
  printf '.SH EXAMPLES\n.nf\n%s\n.fi\n' "$(examples <<<"$help" | roff)"
  cat <<'END'
.SH EXIT STATUS
.TP
.B 0
done
.TP
.B 1
the input or a file is bad
.TP
.B 2
the command line is wrong
.TP
.B 3
memory or disk ran out
.TP
.B 130
interrupted
END
  printf '.SH SEE ALSO\n'
  if [[ -n $command ]]; then printf '.BR reeb (1)\n'; else
    printf '.BR reeb\\-%s (1)' "${commands[0]}"
    printf ',\n.BR reeb\\-%s (1)' "${commands[@]:1}"
    echo
  fi
}

mapfile -t commands < <("$reeb" --help | items Commands | cut -f1)
page "" >"$out/man/reeb.1"
for command in "${commands[@]}"; do page "$command" >"$out/man/reeb-$command.1"; done

# The program is asked once for each command.
declare -A options_of
for command in "${commands[@]}"; do options_of[$command]=$("$reeb" "$command" --help | items Options); done
options() { echo "${options_of[$1]}"; }

# What the completion of bash knows of a command: its options, those with a value, and those whose value is a file.
words_of() {
  options "$1" | awk -F '\t' '
    {
      count = split($1, part, " ")
      names = split(part[1], name, ",")
      for (i = 1; i <= names; ++i) {
        words = words name[i] " "
        if (count > 1) values = values name[i] "|"
        if (part[2] ~ /^(FILE|DIR|MESH|OUT)$/) files = files name[i] "|"
      }
    }
    END { printf "words='\''%s'\'' files='\''|%s'\'' values='\''|%s'\''", words, files, values }'
}

{
  cat <<END
# Completion of reeb for bash.
_reeb() {
  local current=\${COMP_WORDS[COMP_CWORD]} previous=\${COMP_WORDS[COMP_CWORD - 1]} command=\${COMP_WORDS[1]} words= files='@()' values='@()'
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '${commands[*]} --help --version' -- "\$current"; compgen -f -- "\$current")
    return
  fi
  case \$command in
END
  for command in "${commands[@]}"; do echo "    $command) $(words_of "$command") ;;"; done
  cat <<END
    *) $(words_of compute) ;;
  esac
  if [[ \$values == *"|\$previous|"* && \$files != *"|\$previous|"* ]]; then
    COMPREPLY=()
  elif [[ \$current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "\$words" -- "\$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "\$current")
  fi
}
complete -o filenames -F _reeb reeb
END
} | sed "s/ files='@()' values='@()'/ files= values=/" >"$out/reeb.bash"

quoted() { sed "s/'/'\\\\''/g; s/\[/(/g; s/\]/)/g; s/:/ -/g"; }
{
  echo '#compdef reeb'
  echo 'local -a commands; commands=('
  "$reeb" --help | items Commands | quoted | while IFS=$'\t' read -r name text; do echo "  '$name:$text'"; done
  echo ')'
  echo 'if (( CURRENT == 2 )); then _describe command commands; _files; return; fi'
  echo 'case $words[2] in'
  for command in "${commands[@]}" '*'; do
    echo "  $command) _arguments '*:file:_files' \\"
    options "${command/\*/compute}" | quoted | while IFS=$'\t' read -r term text; do
      value=${term#* } names=${term%% *} action=
      [[ $value != "$term" ]] && action=":${value//[()]/}: "
      [[ $value =~ ^(FILE|DIR|MESH|OUT)$ ]] && action=":$value:_files"
      for name in ${names//,/ }; do echo "    '*${name}[$text]$action' \\"; done
    done
    echo '    ;;'
  done
  echo 'esac'
} >"$out/_reeb"

{
  echo '# Completion of reeb for fish.'
  "$reeb" --help | items Commands | quoted | while IFS=$'\t' read -r name text; do
    echo "complete -c reeb -n __fish_use_subcommand -a $name -d '$text'"
  done
  for command in "${commands[@]}"; do
    options "$command" | quoted | while IFS=$'\t' read -r term text; do
      value=${term#* } names=${term%% *} words=
      [[ $value != "$term" ]] && words=' -r'
      [[ -n $words && ! $value =~ ^(FILE|DIR|MESH|OUT)$ ]] && words=' -x'
      for name in ${names//,/ }; do
        if [[ $name == --* ]]; then words+=" -l ${name#--}"; else words+=" -s ${name#-}"; fi
      done
      echo "complete -c reeb -n '__fish_seen_subcommand_from $command'$words -d '$text'"
    done
  done
} >"$out/reeb.fish"
