#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# check_hardening.sh finds all that a program built without any protection lacks. usage: check_hardening_test.sh COMPILER
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
printf 'int main() { return 0; }\n' >"$folder/plain.cpp"
"$1" -fcf-protection=none -fno-stack-protector -no-pie -z norelro -z lazy -z execstack "$folder/plain.cpp" -o "$folder/plain" 2>/dev/null ||
  "$1" -fno-stack-protector -no-pie -z norelro -z lazy -z execstack "$folder/plain.cpp" -o "$folder/plain"
found=$("$(dirname "${BASH_SOURCE[0]}")/check_hardening.sh" "$folder/plain") && { echo 'nothing was found'; exit 1; }
for breach in 'not position independent' 'no RELRO' 'binds symbols late' 'executable stack' 'no stack protector' \
  'no _FORTIFY_SOURCE'; do
  grep -q "$breach" <<<"$found" || { echo "not found: $breach"; exit 1; }
done
