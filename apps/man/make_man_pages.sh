#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Writes a man page for a program and for each of its verbs, from what --help prints.
# usage: make_man_pages.sh PROGRAM FOLDER
set -euo pipefail
program=$1
folder=$2
name=$(basename "$program")
mkdir -p "$folder"

# page NAME ARGUMENT...: the man page of "PROGRAM ARGUMENT...".
page() {
  local command
  printf -v command '%q ' "$program" "${@:2}"
  help2man --no-info --no-discard-stderr --section 1 --manual 'Papilla' --source "$version" \
    --name "$(summary "${@:2}")" --version-string "$1 ${version##* }" --output "$folder/$1.1" "${command% }"
}

# The first line of a help text without "NAME: ".
summary() { "$program" "$@" --help | sed -n '/./{s/^[a-z-]*: //;p;q}'; }

version=$("$program" --version)
page "$name"
for verb in $("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p'); do
  page "$name-$verb" "$verb"
done
