#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# libpapilla.so exports the functions of its header, all of them and nothing else, and its name has the number of the
# interface. usage: exports_test.sh LIBRARY HEADER
set -euo pipefail
library=$1 header=$2
export LC_ALL=C

abi=$(sed -n 's/^#define PAPILLA_HAPTIC_ABI //p' "$header")
soname=$(readelf -d "$library" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')
[[ $soname == "libpapilla.so.$abi" ]] || { echo "SONAME is $soname, the interface has number $abi"; exit 1; }

declared=$(sed -n 's/^PAPILLA_HAPTIC_API [^(]* \**\(papilla_haptic_[a-z_]*\)(.*/\1/p' "$header" | sort)
exported=$(nm -D --defined-only "$library" | awk '$2 != "A" {print $3}' | sort)
[[ $(wc -l <<<"$declared") -ge 14 ]] || { echo "the header declares too little: $declared"; exit 1; }
diff <(sed "s/\$/@@PAPILLA_$abi/" <<<"$declared") <(echo "$exported") ||
  { echo 'declared (<) and exported (>) differ'; exit 1; }
