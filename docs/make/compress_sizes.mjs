// SPDX-License-Identifier: MIT
// The table of sizes in docs/files.md: what papilla writes beside gltf-transform with the same codecs, as Markdown.
//   node compress_sizes.mjs PAPILLA SCENE MATERIALS.json FOLDER
// GLTF_TRANSFORM names the program gltf-transform (npm: @gltf-transform/cli); without it its columns are left out.
import { execFileSync } from 'node:child_process';
import { mkdirSync, statSync } from 'node:fs';
import { join } from 'node:path';

const [papilla, scene, materials, folder] = process.argv.slice(2), tool = process.env.GLTF_TRANSFORM;
if (!folder) {
  console.error('usage: node compress_sizes.mjs PAPILLA SCENE MATERIALS.json FOLDER');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const run = (program, words) => execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

/** Bytes of the whole file. */
function bake(name, options) {
  const file = join(folder, `${name}.glb`);
  run(papilla, ['bake', scene, '-m', materials, '-o', file, '--cache', join(folder, 'cache'), '-q', ...options]);
  return statSync(file).size;
}

function optimize(name, codec, options) {
  const file = join(folder, `${name}-${codec}.glb`);
  run(tool, ['optimize', join(folder, 'plain.glb'), file, '--compress', codec, '--texture-compress', 'webp', ...options]);
  return statSync(file).size;
}

/** Keeps triangles, meshes and instances. */
const KEPT = ['--simplify', 'false', '--join', 'false', '--flatten', 'false', '--palette', 'false'];
const bytes = (n) => n.toLocaleString('en-US');
const row = (cells) => console.log(`| ${cells.join(' | ')} |`);

const plain = bake('plain', []);
console.log(run(papilla, ['--version']).trim() + (tool ? `, gltf-transform ${run(tool, ['--version']).trim()}` : '; GLTF_TRANSFORM names no program') + '\n');
row(['`C`', '`papilla bake … --compress C --images webp`', ...tool ? ['`gltf-transform optimize`, its defaults', 'with all triangles and instances', 'ours to the smaller of both'] : []]);
row(Array(tool ? 5 : 2).fill('---'));
row(['not compressed', bytes(plain), ...tool ? ['', '', ''] : []]);
for (const codec of ['meshopt', 'draco', 'quantize']) {
  const ours = bake(codec, ['--compress', codec, '--images', 'webp']);
  const theirs = tool ? [optimize('defaults', codec, []), optimize('kept', codec, KEPT)] : [];
  row([`\`${codec}\``, bytes(ours), ...theirs.map(bytes), ...tool ? [(ours / Math.min(...theirs)).toFixed(2)] : []]);
}
