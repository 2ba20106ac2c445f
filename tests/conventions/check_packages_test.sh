#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Shows that check_packages.mjs finds each kind of breach, and nothing in packages without one.
# usage: check_packages_test.sh NODE
set -euo pipefail
node=$1 check=$(cd "$(dirname "$0")" && pwd)/check_packages.mjs
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/a/b"
failures=0

# expect BREACH ENGINES RANGE [RESOLVED]: what the check prints of a package that has ENGINES and depends on one that
# asks for RANGE and comes from RESOLVED; BREACH is empty when nothing is wrong.
expect() {
  local output
  printf '{"engines": {"node": "%s"}}' "$2" >"$tree/a/b/package.json"
  printf '{"packages": {"": {}, "x": {"engines": {"node": "%s"}, "resolved": "%s"}}}' "$3" \
    "${4-https://registry.npmjs.org/x.tgz}" >"$tree/a/b/package-lock.json"
  output=$("$node" "$check" "$tree" || true)
  if [[ $output != *"$1"* || $output == *$'\n'* || (-z $1 && -n $output) ]]; then
    printf 'expected "%s" of %s, got: %s\n' "$1" "${*:2}" "$output"
    failures=$((failures + 1))
  fi
}

for range in '*' '>=18' '>= 10.0.0' '18' '18.x' '^18.17.0 || ^20.3.0 || >=21' '>=12 <19' '~18.20.1' '<=18' '10 || 12 || >=14'; do
  expect '' '>=18' "$range"
done
for range in '>=20' '>=18.21' '^20.3.0 || >=21' '<18' '>18' '16.x' '~18.19.0' '>=18.20.5' '>=12 <18.20'; do
  expect 'a/b/package-lock.json: x needs Node.js' '>=18' "$range"
done
expect 'a/b/package.json: "engines"' '>=20' '>=18'
expect 'comes from' '>=18' '>=18' 'https://example.org/x.tgz'

echo "$failures failures"
((failures == 0))
