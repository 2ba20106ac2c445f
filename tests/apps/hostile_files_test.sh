#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that name other people's files: exit code 3, one line, no output, and nothing of those files in any output.
# usage: hostile_files_test.sh PAPILLA PLAYER FOLDER
set -u
papilla=$1 player=$2
# shellcheck source=tests/apps/failures.sh
source "$(dirname "$0")/failures.sh" "$3"
mkdir "scene"

readonly secret='top:secret:words'  # One word: no line of a recipe library.
printf '%s\n' "$secret" >secret.txt
"$papilla" synthesize grain --kind leather --size 16 -o secret.png -q || fail "no picture"
cp secret.png scene/grain.png
printf 'v 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >triangle.obj
"$papilla" repair triangle.obj -o triangle.glb -q || fail "no scene"
ln -s ../secret.txt scene/link.txt
ln -s ../secret.png scene/link.png
ln -s .. scene/up
mkfifo scene/pipe.png

# glTF with an image and a buffer, each named by a URI.
base64_of() { base64 -w0; }
points='AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'
gltf() {
  local buffer=${2-data:application/octet-stream;base64,$points}
  printf '{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"%s"}],"bufferViews":[{"buffer":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],
    "images":[{"uri":"%s"}],"textures":[{"source":0}],
    "materials":[{"name":"g","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}]}' "$buffer" "$1" >scene/a.gltf
}
printf '{"materials": {"g": {"stiffness": 300}}, "assign": [{"part": "*", "material": "g"}]}' >scene/rules.json

# refused PATTERN COMMAND...: exit code 3, one line that matches, no output, no word of a secret.
refused() {
  local pattern=$1 got
  shift
  rm -rf out && mkdir out
  timeout 60 "$@" >out.txt 2>err.txt </dev/null
  got=$?
  if [[ $got != 3 || $(wc -l <err.txt) != 1 ]] || ! grep -qE -- "$pattern" err.txt; then
    fail "exit $got: $*: $(cat err.txt)"
  fi
  [[ -z $(find out -type f) ]] || fail "$* left $(find out -type f)"
  ! grep -rqF "$secret" out out.txt err.txt || fail "$* tells the secret"
}

# Every door: GLB, OBJ with pictures, page, picture, report, measurement, player.
doors() {
  local pattern=$1
  refused "$pattern" "$papilla" inspect scene/a.gltf --picture out/a.png --json out/a.json
  refused "$pattern" "$papilla" repair scene/a.gltf -o out/a.glb
  refused "$pattern" "$papilla" repair scene/a.gltf -o out/a.obj
  refused "$pattern" "$papilla" view scene/a.gltf -o out/a.html --no-open
  refused "$pattern" "$papilla" bake scene/a.gltf -m scene/rules.json -o out/a.glb --report out/report --pictures
  refused "$pattern" "$player" scene/a.gltf --seconds 0.1 --json out/a.json
}
gltf ../secret.txt && doors "a.gltf: at /images/0/uri: '../secret.txt' leads out"
for uri in ../secret.png %2e%2e/secret.png '..%2Fsecret.png' "$folder/secret.png" ../../../../../../../../etc/passwd \
  link.png link.txt up/secret.txt /etc/passwd ../no/such/file; do
  gltf "$uri"
  refused "a.gltf: at /images/0/uri: .* leads out" "$papilla" repair scene/a.gltf -o out/a.glb
  gltf grain.png "$uri"
  refused "a.gltf: at /buffers/0/uri: .* leads out" "$papilla" repair scene/a.gltf -o out/a.glb
done
printf '%s\n' "$secret" >scene/notes.txt
gltf notes.txt && doors "a.gltf: at /images/0/uri: 'notes.txt' is no picture"
gltf pipe.png && refused "'pipe.png' is no regular file" "$papilla" repair scene/a.gltf -o out/a.glb
gltf grain.png pipe.png && refused "'pipe.png' is no regular file" "$papilla" repair scene/a.gltf -o out/a.glb
gltf grain.png && "$papilla" repair scene/a.gltf -o a.glb -q || fail "a picture beside the file is read"

# OBJ, MTL and PLY.
obj() {
  printf 'mtllib %s\nv 0 0 0\nv 10 0 0\nv 0 10 0\nusemtl g\nf 1 2 3\n' "$1" >scene/a.obj
  printf 'newmtl g\nmap_Kd %s\n' "$2" >scene/a.mtl
}
for name in ../secret.png link.png "$folder/secret.png"; do
  obj a.mtl "$name" && refused "a.mtl: line 2: .* leads out" "$papilla" view scene/a.obj -o out/a.html --no-open
  printf 'ply\nformat ascii 1.0\ncomment TextureFile %s\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' "$name" >scene/a.ply
  refused "a.ply: line 3: .* leads out" "$papilla" repair scene/a.ply -o out/a.glb
done
obj ../secret.txt grain.png && refused "a.obj: line 1: .* leads out" "$papilla" repair scene/a.obj -o out/a.glb
obj notes.txt grain.png && refused "notes.txt" "$papilla" repair scene/a.obj -o out/a.glb
obj a.mtl notes.txt && refused "a.mtl: line 2: .*no picture" "$papilla" repair scene/a.obj -o out/a.glb
obj a.mtl pipe.png && refused "a.mtl: line 2: .*no regular file" "$papilla" repair scene/a.obj -o out/a.glb

# Recipes: what they include and the pictures that they show.
printf 'include ../secret.txt\n' >scene/a.recipes
refused "a.recipes: line 1: '../secret.txt' leads out" "$papilla" texture noise --library scene/a.recipes -o out --size 8
printf 'include notes.txt\n' >scene/a.recipes
refused "notes.txt: line 1: expected" "$papilla" texture noise --library scene/a.recipes -o out --size 8
(cd scene && refused "'../secret.png' leads out" "$papilla" texture 'image|picpath=../secret.png' -o ../out --size 8) || failures=$((failures + 1))
printf '{"layers": [{"recipe": "image|picpath=../secret.png"}], "size": 16}' >scene/config.json
refused "'../secret.png' leads out" "$papilla" weather triangle.glb -c scene/config.json -o out/a.glb
printf '{"layers": [{"recipe": "noise"}], "libraries": ["../secret.txt"], "size": 16}' >scene/config.json
refused "config.json: at /libraries/0: '../secret.txt' leads out" "$papilla" weather triangle.glb -c scene/config.json -o out/a.glb

# The pictures of MATERIALS.json, which its user wrote, may lie anywhere, but must be pictures.
rules() { printf '{"materials": {"g": {"texture": "%s", "size_mm": [40, 40]}}, "assign": [{"part": "*", "material": "g"}]}' "$1" >scene/rules.json; }
rules ../secret.png && "$papilla" bake triangle.glb -m scene/rules.json -o a.glb -q || fail "a picture elsewhere is read"
rules pipe.png && refused "pipe.png: is not a regular file" "$papilla" bake triangle.glb -m scene/rules.json -o out/a.glb
rules ../secret.txt && refused "secret.txt" "$papilla" bake triangle.glb -m scene/rules.json -o out/a.glb

finish "hostile files"
