#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What the programs say to wrong words, and with which exit code: words_test.sh PAPILLA PLAYER DATA_FOLDER OUTPUT_FOLDER
set -uo pipefail
papilla=$1 player=$2 data=$3 out=$4
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$out"

# says TEXT CODE COMMAND...: standard error has TEXT and the exit code is CODE.
says() {
  local text=$1 code=$2 got
  shift 2
  "$@" >"$out/stdout" 2>"$out/stderr"
  got=$?
  ((got == code)) || fail "${*:2}: exit code $got, expected $code"
  grep -qF -- "$text" "$out/stderr" || fail "${*:2}: expected '$text', got '$(head -n 1 "$out/stderr")'"
}

verbs=$("$papilla" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p')
[[ $(wc -w <<<"$verbs") -ge 16 ]] || fail "only these verbs: $verbs"

says "unknown verb 'bogus'; did you mean 'bake'?" 2 "$papilla" bogus
says "unknown verb 'unwarp'; did you mean 'unwrap'?" 2 "$papilla" unwarp in.stl
for verb in $verbs; do
  says "$verb: unknown option '--quite'; did you mean '--quiet'?" 2 "$papilla" "$verb" --quite
  says "--progress: 'jsn' is none of auto,json,none; did you mean 'json'?" 2 "$papilla" "$verb" --progress jsn
  says "--threads: -1 is not from 0 to 1024" 2 "$papilla" "$verb" --threads -1
  # An object with the error on standard output, one line on standard error.
  "$papilla" "$verb" --bogus --json - >"$out/error.json" 2>/dev/null
  grep -q "\"error\": \"$verb: unknown option '--bogus'" "$out/error.json" || fail "$verb --json -: no error in JSON"
done
says "bake: unknown option '--materals'; did you mean '--materials'?" 2 "$papilla" bake a.stl --materals=b.json -o c.glb
says "--method: 'lscn' is none of" 2 "$papilla" unwrap a.stl -o b.glb --method lscn
says "did you mean 'lscm'?" 2 "$papilla" unwrap a.stl -o b.glb --method lscn
says "--chord: 0 is not from 0.000001 to 1000" 2 "$papilla" inspect a.stl --chord 0
says "--budget: -5 is not above 0" 2 "$papilla" bake a.stl -m b.json -o c.glb --budget -5
says "--weld: 'x' is no number" 2 "$papilla" repair a.stl -o b.stl --weld x
says "kind: 'tesselation' is none of param,weld," 2 "$papilla" evaluate tesselation -o "$out/evaluation"
says "did you mean 'tessellation'?" 2 "$papilla" evaluate tesselation -o "$out/evaluation"

# A bound on distortion that can't be kept is said; with --strict it is an error, and nothing is written.
awk 'BEGIN { n = 80; for (i = 0; i <= n; ++i) for (j = 0; j <= n; ++j) { x = i / n - 0.5; y = 1.4 * (j / n - 0.5); print "v", 10 * x, 10 * y, 9 * x * x + 5 * y * y }
  for (i = 0; i < n; ++i) for (j = 0; j < n; ++j) { a = i * (n + 1) + j + 1; b = a + n + 1; print "f", a, b, b + 1; print "f", a, b + 1, a + 1 } }' >"$out/bowl.obj"
says "the bound of 4 can't be kept" 4 "$papilla" unwrap "$out/bowl.obj" -o "$out/strict.glb" --max-distortion 4 --strict
[[ ! -e $out/strict.glb ]] || fail "unwrap --strict: wrote a file"
"$papilla" unwrap "$out/bowl.obj" -o "$out/bound.glb" --max-distortion 4 --json "$out/bound.json" >"$out/stdout" || fail "unwrap --max-distortion 4: exit code $?"
grep -q "can't be kept" "$out/stdout" || fail "unwrap --max-distortion 4: not said"
grep -q '"kept": false' "$out/bound.json" || fail "unwrap --max-distortion 4: not in JSON"
"$papilla" unwrap "$out/bowl.obj" -o "$out/bound.glb" --max-distortion p95=4.2 --json "$out/bound.json" >"$out/stdout" || fail "unwrap --max-distortion p95=4.2"
grep -q "the bound of p95=4.2 is kept" "$out/stdout" || fail "unwrap --max-distortion p95=4.2: $(cat "$out/stdout")"
says "--seam-cost: --max-distortion finds it, give one of the two" 2 "$papilla" unwrap a.stl -o b.glb --max-distortion 4.1 --seam-cost 0.1
says "--max-distortion '3.9': expected D or pNN=D" 2 "$papilla" unwrap a.stl -o b.glb --max-distortion 3.9

# Options from a file: the command line goes before it, an object of the verb's name before what stands outside.
echo '{"chord": 1, "quiet": true, "unwrap": {"method": "lscm"}, "inspect": {"nodes": true, "up": null}}' >"$out/options.json"
"$papilla" tessellate "$data/exchange/handle.step" --config "$out/options.json" -o "$out/coarse.glb" --json "$out/coarse.json" >"$out/stdout" || fail "tessellate --config"
[[ -s $out/stdout ]] && fail "\"quiet\": true printed $(head -n 1 "$out/stdout")"
"$papilla" tessellate "$data/exchange/handle.step" --config "$out/options.json" --chord 0.05 -o "$out/fine.glb" --json "$out/fine.json" || fail "tessellate --config --chord"
"$papilla" tessellate "$data/exchange/handle.step" --chord 1 -o "$out/given.glb" --quiet || fail "tessellate --chord"
cmp -s "$out/coarse.glb" "$out/given.glb" || fail "a chord from a file is not that of the command line"
(($(stat -c %s "$out/fine.glb") > $(stat -c %s "$out/coarse.glb"))) || fail "--chord did not go before the file"
"$papilla" unwrap "$out/coarse.glb" --config "$out/options.json" -o "$out/u.glb" --json "$out/u.json" || fail "unwrap --config"
grep -q '"method": "lscm"' "$out/u.json" || fail "the object of the verb was not read"
echo "{\"IN\": \"$out/coarse.glb\", \"output\": \"$out/all.glb\", \"grain\": [\"0,0,1\"], \"tile\": [10, 20], \"seam_cost\": 0.2}" >"$out/all.json"
"$papilla" unwrap --config "$out/all.json" --quiet || fail "unwrap with everything in a file"
[[ -s $out/all.glb ]] || fail "output of a file was not written"
refused() {
  echo "$1" >"$out/bad.json"
  says "$2" 3 "$papilla" unwrap "$out/coarse.glb" -o "$out/u.glb" --config "$out/bad.json"
}
refused '{"methd": "lscm"}' "bad.json: /methd: 'unwrap' has no such option; did you mean 'method'?"
refused '{"unwrap": {"chrod": 1}}' "bad.json: /unwrap/chrod: 'unwrap' has no such option; did you mean 'chord'?"
refused '{"quiet": 1}' "bad.json: /quiet: must be true or false"
refused '{"grain": [{}]}' "bad.json: /grain/0: must be a text or a number"
refused '{"config": "x.json"}' "bad.json: /config: a file of options can't name another one"
refused '[1]' "bad.json: must be an object of options"
refused '{"method": ' "bad.json: byte 13 is no JSON"
echo '{"method": "lscn"}' >"$out/bad.json"
says "--method: 'lscn' is none of" 2 "$papilla" unwrap "$out/coarse.glb" -o "$out/u.glb" --config "$out/bad.json"
says "missing.json: does not exist" 3 "$papilla" unwrap "$out/coarse.glb" -o "$out/u.glb" --config "$out/missing.json"

# A picture that a recipe of MATERIALS.json names is looked for in that file's folder.
mkdir -p "$out/named/pictures"
"$papilla" synthesize grain --kind quads6 --size 64 -o "$out/named/pictures/grain.png" --quiet || fail "synthesize"
echo '{"materials": {"m": {"texture": "image|picpath=pictures/grain.png", "size_mm": [40, 40]}}, "assign": [{"part": "*", "material": "m"}]}' >"$out/named/m.json"
"$papilla" plan "$out/coarse.glb" -m "$out/named/m.json" --json "$out/named/plan.json" --quiet || fail "a picture in a folder below MATERIALS.json"
grep -q 'does not exist' "$out/named/plan.json" && fail "a picture in a folder below MATERIALS.json is not found"

says "unknown option '--devise'; did you mean '--device'?" 2 "$player" --devise sim
says "--motion: 'strok' is none of stroke,circle,slide,tap; did you mean 'stroke'?" 2 "$player" a.glb --motion strok

"$papilla" inspect "$out/missing.stl" --json - >"$out/error.json" 2>/dev/null
[[ $? -eq 3 ]] || fail "a missing file is no input error"
grep -q '"error": ".*missing.stl' "$out/error.json" || fail "inspect --json -: $(cat "$out/error.json")"
grep -q '"exit_code": 3' "$out/error.json" || fail "inspect --json -: no exit code"
"$player" "$out/missing.glb" --json - >"$out/error.json" 2>/dev/null
grep -q '"error"' "$out/error.json" || fail "player --json -: no error"

# What can't be written is known before anything is read.
says "$out/nowhere/a.glb: the folder $out/nowhere does not exist" 3 "$papilla" bake "$data/exchange/slider.stl" \
  -m "$out/missing.json" -o "$out/nowhere/a.glb"
says "$out/nowhere/a.csv: the folder" 3 "$papilla" unwrap "$out/missing.stl" -o "$out/a.glb" --trace "$out/nowhere/a.csv"

# A budget that can't be reached.
says "the budget of 1 triangles can't be reached" 4 "$papilla" simplify "$data/exchange/slider.stl" -o "$out/strict.glb" \
  --budget 1 --strict
[[ ! -e $out/strict.glb ]] || fail "simplify --strict: wrote a file"
"$papilla" simplify "$data/exchange/slider.stl" -o "$out/strict.glb" --budget 1 -q || fail "simplify --budget 1"

# A picture of grain that is not there, of which material?
cat >"$out/materials.json" <<'JSON'
{"materials": {"hide": {"texture": "lether", "size_mm": [40, 40]}}, "assign": [{"part": "*", "material": "hide"}]}
JSON
says "material 'hide', texture: " 3 "$papilla" bake "$data/exchange/slider.stl" -m "$out/materials.json" -o "$out/a.glb"
says "did you mean 'leather'?" 3 "$papilla" bake "$data/exchange/slider.stl" -m "$out/materials.json" -o "$out/a.glb"

# The material library.
"$papilla" materials list --json "$out/list.json" -q || fail "materials list: exit code $?"
[[ $(grep -c '"dynamic_friction"' "$out/list.json") -ge 60 ]] || fail "materials list: fewer than 60"
grep -q '^metal/aluminium-brushed ' <("$papilla" materials search gebuerstetes aluminium) || fail "materials search: umlauts"
grep -qF "nothing is called 'velurs'; near are" <("$papilla" materials search velurs) || fail "materials search: near names"
"$papilla" materials check >"$out/check.txt" || fail "materials check: $(cat "$out/check.txt")"
"$papilla" materials show wood/cork --picture "$out/cork.png" --picture-px 64 -q || fail "materials show: exit code $?"
[[ -s $out/cork.png ]] || fail "materials show: no picture"
says "the library has no material 'wood/crok'; did you mean 'wood/cork'?" 3 "$papilla" materials show wood/crok
says "materials show needs the id of one material" 2 "$papilla" materials show
says "materials search needs words" 2 "$papilla" materials search
says "materials page needs -o" 2 "$papilla" materials page
says "what: 'serach' is none of list,show,search,check,page; did you mean 'search'?" 2 "$papilla" materials serach leather
says "$out/nowhere" 3 "$papilla" materials list --library "$out/nowhere"
mkdir -p "$out/own/wood"
sed 's/"estimated": true/"estimate": true/' "$data/materials/wood/cork.json" >"$out/own/wood/cork.json"
"$papilla" materials check "$out/own" >"$out/check.txt"
[[ $? -eq 3 ]] || fail "materials check: a wrong file is no input error"
grep -qF "unknown key 'estimate'; did you mean 'estimated'?" "$out/check.txt" || fail "materials check: $(cat "$out/check.txt")"
cp "$data/materials/wood/cork.json" "$out/own/wood/cork.json"
"$papilla" materials page --library "$out/own" -o "$out/page.html" --picture-px 64 -q || fail "materials page: exit code $?"
grep -q 'src="data:image/png' "$out/page.html" || fail "materials page: no picture within"
"$papilla" materials page --library "$out/own" -o "$out/page" --picture-px 64 -q || fail "materials page: exit code $?"
[[ -s $out/page/index.html && -s $out/page/wood_cork.png ]] || fail "materials page: no folder"
cat >"$out/library.json" <<'JSON'
{"materials": {"m": {"material": "library:wood/crok"}}, "assign": [{"part": "*", "material": "m"}]}
JSON
says "at /materials/m/material: the library has no material 'wood/crok'; did you mean 'wood/cork'?" 3 \
  "$papilla" plan "$data/exchange/slider.stl" -m "$out/library.json"
sed -i 's/crok/cork/' "$out/library.json"
"$papilla" plan "$data/exchange/slider.stl" -m "$out/library.json" --material-library "$out/own" -q || fail "plan: $?"
says "the library has no material" 3 "$papilla" bake "$data/exchange/slider.stl" -m "$out/library.json" \
  --material-library "$data/exchange" -o "$out/a.glb"
# Suggested, and not applied.
echo '{"materials": {}}' >"$out/none.json"
"$papilla" plan "$data/cockpit.step" -m "$out/none.json" --chord 1 --json "$out/plan.json" >"$out/plan.txt" || fail "plan: $?"
grep -qF "nothing of it is applied" "$out/plan.txt" || fail "plan suggests nothing"
grep -qF '"library:carpet/' "$out/plan.json" || fail "plan: no carpet for floor_carpet"
grep -A1 '"stage": "tag"' "$out/plan.json" | grep -q '"run": true' && fail "plan: something suggested is applied"

# A material from a stroke of the player, which plan reads.
printf 'v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nf 1 2 3\nf 1 3 4\n' >"$out/plate.obj"
echo '{"materials": {"m": {"stiffness": 350, "damping": 0.05, "staticFriction": 0.4, "dynamicFriction": 0.3}}, "assign": [{"part": "*", "material": "m"}]}' >"$out/m.json"
"$papilla" bake "$out/plate.obj" -m "$out/m.json" -o "$out/plate.glb" -q || fail "bake: exit code $?"
"$player" "$out/plate.glb" --seconds 2 --record "$out/stroke.csv" -q || fail "player: exit code $?"
"$papilla" fit "$out/stroke.csv" -o "$out/fitted.json" --material felt --json "$out/fit.json" >"$out/fit.txt" || fail "fit: exit code $?"
grep -q "^stiffness  *[0-9]" "$out/fit.txt" || fail "fit: $(cat "$out/fit.txt")"
grep -q "^not identified: static_friction: " "$out/fit.txt" || fail "fit: $(cat "$out/fit.txt")"
"$papilla" plan "$out/plate.obj" -m "$out/fitted.json" --strict -q || fail "plan of a fitted material: exit code $?"
printf 't,x,y,z\n0,0,0,0\n' >"$out/hand.csv"
says "hand.csv:1: the heading has no column force_x" 3 "$papilla" fit "$out/hand.csv"
head -n 200 "$out/stroke.csv" >"$out/air.csv"
says "air.csv: the stroke never presses" 3 "$papilla" fit "$out/air.csv"
says "--surface: 'plan' is none of auto,recorded,plane; did you mean 'plane'?" 2 "$papilla" fit a.csv --surface plan
# Studies.
says "what: 'analys' is none of new,run,analyse,simulate; did you mean 'analyse'?" 2 "$papilla" study analys
says "study new needs -o" 2 "$papilla" study new
says "study run needs a STUDY.json" 2 "$papilla" study run --participant 1
says "study run needs --participant" 2 "$papilla" study run "$out/missing.json"
says "--page" 2 "$papilla" study run "$out/missing.json" --participant 1 --port 80
says "$out/missing.json" 3 "$papilla" study run "$out/missing.json" --participant 1
says "experiments: 'dimensions' is none of grains, recognisability, roughness, dimension, height; did you mean 'dimension'?" \
  3 "$papilla" study new -o "$out/study" --experiments dimensions
says "dimensions: 3.5 is not from 2.02 to 2.98" 3 "$papilla" study new -o "$out/study" --dimensions 2.1,3.5
[[ ! -e $out/study ]] || fail "study new: a refused study has a folder"

# Rules that take nothing: a warning, or with --strict an error.
cat >"$out/rules.json" <<'JSON'
{"materials": {"hard": {"stiffness": 2000}}, "assign": [{"part": "vent_salt*", "material": "hard"}]}
JSON
line="rule 1 (/assign/0): part 'vent_salt*' matches nothing; did you mean 'vent_slat'?"
"$papilla" plan "$data/exchange/vent.glb" -m "$out/rules.json" >"$out/plan.txt" || fail "plan: exit code $?"
grep -qF "warning: $line" "$out/plan.txt" || fail "plan: no warning"
"$papilla" plan "$data/exchange/vent.glb" -m "$out/rules.json" --strict -q
[[ $? -eq 3 ]] || fail "plan --strict does not end with 3"
"$papilla" bake "$data/exchange/vent.glb" -m "$out/rules.json" -o "$out/b.glb" >"$out/bake.txt" || fail "bake: exit code $?"
grep -qF "no rule took a surface" "$out/bake.txt" || fail "bake: $(cat "$out/bake.txt")"
says "$line" 3 "$papilla" bake "$data/exchange/vent.glb" -m "$out/rules.json" -o "$out/c.glb" --strict
[[ ! -e $out/c.glb ]] || fail "bake --strict wrote its output"

# Weather that lies nowhere, or on a scene without uv, writes nothing.
echo '{"size": 16, "layers": [{"recipe": "dust", "materials": ["satn"]}]}' >"$out/weather.json"
says "materials 'satn' matches nothing; did you mean 'satin'?" 3 \
  "$papilla" weather "$data/exchange/vent.glb" -c "$out/weather.json" -o "$out/d.glb"
echo '{"size": 16, "layers": [{"recipe": "dust"}]}' >"$out/weather.json"
printf 'usemtl steel\nv 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n' >"$out/plain.obj"
says "has no texture coordinates, which the layers need" 3 \
  "$papilla" weather "$out/plain.obj" -c "$out/weather.json" -o "$out/d.glb"
[[ ! -e $out/d.glb ]] || fail "weather wrote its output"

# Units.
cp "$data/exchange/slider.stl" "$out/sofa.stl"
"$papilla" inspect "$data/exchange/slider.stl" | head -n 1 | grep -qF "units mm (assumed)" || fail "no assumed unit"
"$papilla" inspect "$data/exchange/slider.stl" --unit mm | head -n 1 | grep -qF "units mm," || fail "a given unit is assumed"
"$papilla" inspect "$data/exchange/slider.stl" | grep -q "small for" && fail "a slider is small"
"$papilla" inspect "$out/sofa.stl" | grep -q "mm, small for a sofa; it would be .* (--unit " || fail "no hint at the unit of a sofa"

# The examples, as README and --help have them.
cd "$data/.." || exit 1
"$papilla" plan data/cockpit.step -m examples/materials.json --chord 1 --strict --json "$out/plan.json" -q ||
  fail "examples/materials.json: a rule takes nothing"
grep -q '"part": "cockpit/driver_seat/seat_cushion"' "$out/plan.json" || fail "the driver's cushion has no plan of its own"
"$papilla" weather data/exchange/vent.glb -c examples/weather.json -o "$out/old-vent.glb" --strict -q ||
  fail "examples/weather.json does not work"
for step in 0000 0001 0002; do [[ -s $out/old-vent.$step.glb ]] || fail "no old-vent.$step.glb"; done

finish "words"
