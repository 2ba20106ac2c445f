# SPDX-License-Identifier: MIT
# Completion for papilla and papilla-player in bash. The verbs, options and choices are asked from the programs
# themselves (--help), so that this file knows none of them.

# Prints the verbs that the help text on stdin lists below "Subcommands:".
_papilla_verbs() { sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p'; }

# Prints the options that the help text on stdin lists.
_papilla_options() {
  sed -n 's/^  \(-[-,A-Za-z0-9]*\).*/\1/p' | tr ',' '\n' | grep -E '^--?[A-Za-z]' | sort -u
}

# Prints the choices of option $1 as the help text on stdin names them: "--progress TEXT:{auto,json,none}".
_papilla_choices() {
  sed -n "s/^  \([^ ]*,\)\?$1[, ][^{]*{\([^}]*\)}.*/\2/p" | head -n 1 | tr ',' '\n'
}

# Prints the choices of the first positional as the help text on stdin names them.
_papilla_first_choices() {
  sed -n '/^Positionals:/,/^$/s/^  [^ ]* [^{]*{\([^}]*\)}.*/\1/p' | head -n 1 | tr ',' '\n'
}

_papilla() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]}
  local help verbs words='' listed='' verb=${COMP_WORDS[1]-}
  help=$("$program" --help 2>/dev/null) || return 0
  verbs=$(_papilla_verbs <<<"$help")
  if [[ -n $verbs ]] && ((COMP_CWORD > 1)) && grep -qxF -- "$verb" <<<"$verbs"; then
    help=$("$program" "$verb" --help 2>/dev/null) || return 0
    verbs=''
  fi

  # What was typed goes into no script: sed runs commands, and compgen -W expands its words.
  if [[ $previous =~ ^--?[A-Za-z][A-Za-z0-9-]*$ ]]; then
    words=$(_papilla_choices "$previous" <<<"$help")
    # A list of choices goes on behind its last comma.
    if [[ -n $words && $current == *,* ]]; then listed=${current%,*},; fi
  fi
  if [[ -z $words && $current == -* ]]; then words=$(_papilla_options <<<"$help"); fi
  if [[ -z $words && $COMP_CWORD -eq 1 ]]; then words=$verbs; fi
  if [[ -z $words && $COMP_CWORD -eq 2 ]]; then words=$(_papilla_first_choices <<<"$help"); fi
  mapfile -t COMPREPLY < <(compgen -P "$listed" -W "$words" -- "${current#"$listed"}")
}

# Where nothing of this fits, file names are completed.
complete -o bashdefault -o default -F _papilla papilla papilla-player
