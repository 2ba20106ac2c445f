#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Completes command lines of a program whose help has the shape that CLI11 prints, and of the real ones.
# usage: completion_test.sh COMPLETION_FILE [PROGRAM...]
set -euo pipefail
# shellcheck source=/dev/null
source "$1"
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

# completed WORD...: what the last word of the command line may become, on one line.
completed() {
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _papilla
  echo "${COMPREPLY[*]}"
}

# expect TEXT WORD...
expect() {
  local got
  got=$(completed "${@:2}")
  if [[ $got != "$1" ]]; then
    printf 'completing "%s": expected "%s", got "%s"\n' "${*:2}" "$1" "$got"
    failures=$((failures + 1))
  fi
}

cat >"$folder/papilla" <<'PROGRAM'
#!/bin/sh
case "$1" in
  measure) cat <<'TEXT'
Usage: papilla measure [OPTIONS] KIND

Positionals:
  KIND TEXT:{area,angle} REQUIRED
                              What to measure
  FILE TEXT                   The {file}

Options:
  --only TEXT:{fractal,class} ...
                              Parts
TEXT
  ;;
  inspect) cat <<'TEXT'
What a file holds
Usage: papilla inspect [OPTIONS] FILE

Positionals:
  FILE TEXT REQUIRED          The file

Options:
  -h,--help                   Print this help message and exit
  -m,--method TEXT:{lscm,triplanar}
                              The method, not --other
[Option Group: Common]
  --progress TEXT:{auto,json,none} [auto]
                              How
TEXT
  ;;
  *) cat <<'TEXT'
Usage: papilla [OPTIONS] SUBCOMMAND

Options:
  -h,--help                   Print this help message and exit
  --version                   Print the version

Subcommands:
  inspect                     What a file holds
  measure                     Numbers
  plan                        What bake would do
  synthesize                  Fractal surfaces

Exit codes: 0 done
TEXT
  ;;
esac
PROGRAM
chmod +x "$folder/papilla"
expect 'inspect measure plan synthesize' "$folder/papilla" ''
expect 'plan' "$folder/papilla" p
expect '--help --version' "$folder/papilla" --
expect '--help --method --progress' "$folder/papilla" inspect --
expect 'auto json none' "$folder/papilla" inspect --progress ''
expect 'triplanar' "$folder/papilla" inspect a.stl -m t
expect 'lscm triplanar' "$folder/papilla" inspect --method ''
expect '' "$folder/papilla" inspect ''
expect 'area angle' "$folder/papilla" measure ''
expect 'angle' "$folder/papilla" measure an
expect '' "$folder/papilla" measure area ''
expect 'class' "$folder/papilla" measure area --only c
expect 'fractal,class' "$folder/papilla" measure area --only fractal,c
expect '' "$folder/missing" ''
# What was typed is not run.
pushd "$folder" >/dev/null
# shellcheck disable=SC2016
expect '$(touch${IFS}pwned),class' "$folder/papilla" measure area --only '$(touch${IFS}pwned),c'
# shellcheck disable=SC2016
expect '`touch pwned`,fractal' "$folder/papilla" measure area --only '`touch pwned`,f'
expect '' "$folder/papilla" measure area $'-x/y/w pwned\ns/\\(-a\\)' 'c'
if [[ -e pwned ]]; then
  echo 'what was typed was run'
  failures=$((failures + 1))
fi
popd >/dev/null
expect 'fractal,fractal fractal,class' "$folder/papilla" measure area --only fractal,

# The choices of the real programs: expect_choices PROGRAM VERB OPTION CHOICES
expect_choices() {
  [[ $(basename "$1") == papilla ]] || return 0
  expect "$4" "$1" "$2" "$3" ''
}
for program in "$@"; do
  expect_choices "$program" unwrap --charts 'auto keep uv'
  expect_choices "$program" evaluate --charts 'auto keep uv'
  expect_choices "$program" evaluate --normalize 'chart none part scene'
  expect_choices "$program" measure --normalize 'chart none part scene'
  expect_choices "$program" unwrap --layout 'atlas tile'
  expect_choices "$program" unwrap --grain 'up longest'
  expect_choices "$program" unwrap --solver 'hermitian cgal gauss-newton gradient-descent direct gauss-seidel'
  expect_choices "$program" inspect --unit 'file mm cm m in ft'
  expect_choices "$program" height --method 'auto wiener variational pentland tsai-shah intensity'
  expect_choices "$program" texture --bits '8 16 32'
  if [[ $(basename "$program") == papilla ]]; then
    expect 'lscm' "$program" unwrap --method ls
    expect 'tessellation' "$program" evaluate tes
    expect 'lscm,best' "$program" evaluate param --method lscm,be
    expect 'grain fractal photo' "$program" synthesize ''
    expect 'list show search check page' "$program" materials ''
    expect 'show search' "$program" materials s
    expect 'new run analyse simulate' "$program" study ''
    expect 'analyse' "$program" study an
    expect 'logistic normal' "$program" study --shape ''
  fi
  expect '--help' "$program" --hel
  for verb in $(completed "$program" ''); do
    expect '--json' "$program" "$verb" --jso
  done
done

echo "$failures failures"
((failures == 0))
