// SPDX-License-Identifier: MIT
// Sends a file with haptic tags through the tools that glTF files meet, lets the player stroke every material of what
// comes out, and compares tags and forces with those of the file as it was.
// usage: node survive.mjs PLAYER SCENE_MAKER EVIDENCE.md; exit code 77 when the tools are not installed (npm ci).
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [player, makeScene, evidence] = process.argv.slice(2);
if (!evidence) {
  console.error('usage: node survive.mjs PLAYER SCENE_MAKER EVIDENCE.md');
  process.exit(2);
}
const here = new URL('.', import.meta.url).pathname;
const cli = join(here, 'node_modules/@gltf-transform/cli/bin/cli.js'), packer = join(here, 'node_modules/gltfpack/cli.js');
if (!existsSync(cli) || !existsSync(packer)) {
  console.log('skipped: the tools are not installed (npm ci)');
  process.exit(77);
}
const hasBlender = spawnSync('blender', ['--version']).status === 0;

const folder = mkdtempSync(join(tmpdir(), 'papilla-survival-'));
const input = join(folder, 'in.glb'), output = join(folder, 'out.glb'), way = join(folder, 'way.csv'), record = join(folder, 'record.csv');
execFileSync(makeScene, [input, way, join(folder, 'strokes.json')]);
const strokes = JSON.parse(readFileSync(join(folder, 'strokes.json'), 'utf8'));
const felt = strokes.filter((stroke) => stroke.felt);

const run = (program, ...args) => execFileSync(program, args, { stdio: 'pipe', cwd: here });
const transform = (command) => () => run('node', cli, command, input, output);
const pack = (...options) => () => run('node', packer, '-i', input, '-o', output, ...options);
const blender = (extras) => () => run('blender', '-b', '--factory-startup', '-noaudio', '--python', join(here, 'blender.py'), '--', input, output, extras);

/** What each tool must leave: how many tags are there of themselves, found again, and how far forces may be off, as a share
 * of their root mean square; of materials whose relief went with the extras there is no bound. */
const EXACT = 0.001, ROUNDED = 0.01, QUANTIZED = 0.02;
const all = felt.length;
const tools = [
  { name: 'as it was written', make: () => writeFileSync(output, readFileSync(input)), kept: all, worst: EXACT },
  ...['copy', 'dedup', 'prune', 'weld', 'flatten', 'join'].map((c) => ({ name: `gltf-transform ${c}`, make: transform(c), kept: all, worst: EXACT })),
  ...['quantize', 'meshopt'].map((c) => ({ name: `gltf-transform ${c}`, make: transform(c), kept: all, worst: QUANTIZED })),
  { name: 'gltf-transform draco', make: transform('draco'), kept: all, worst: QUANTIZED },
  { name: 'gltf-transform webp', make: transform('webp'), kept: all, worst: EXACT },
  { name: 'gltf-transform optimize', make: transform('optimize'), kept: all, worst: QUANTIZED },
  { name: 'gltfpack -ke', make: pack('-ke'), kept: all, worst: QUANTIZED },
  { name: 'gltfpack -ke -cc', make: pack('-ke', '-cc'), kept: all, worst: QUANTIZED },
  { name: 'gltfpack', make: pack(), kept: 0, restored: all, worst: QUANTIZED, reliefLost: true },
  { name: 'three.js', make: () => run('node', join(here, 'three.mjs'), input, output), kept: all, worst: EXACT },
  { name: 'Blender, with extras', make: blender('1'), kept: all, worst: ROUNDED, needsBlender: true },
  { name: 'Blender, without extras', make: blender('0'), kept: 0, restored: 0, refused: true, needsBlender: true },
  { name: 'Blender, without extras, --tags', make: blender('0'), kept: 0, restored: all, worst: ROUNDED, tags: true, needsBlender: true },
];

/** The force on every tick of the way, by material. */
function forcesOf(csv) {
  const rows = csv.trim().split('\n').slice(1).map((line) => line.split(',').map(Number));
  return felt.map(({ from, to }) => rows.filter((row) => row[0] >= from && row[0] < to).map((row) => row.slice(10, 13)));
}

const rms = (vectors) => Math.sqrt(vectors.reduce((sum, v) => sum + v[0] ** 2 + v[1] ** 2 + v[2] ** 2, 0) / vectors.length);

/** Root mean square of the difference over that of the force before, for each material. */
function differences(before, after) {
  return felt.map((_, i) => rms(before[i].map((f, k) => f.map((value, axis) => value - after[i][k][axis]))) / rms(before[i]));
}

/** Plays it, again when the machine paused the player, as it does under load: the force fades in anew after that. */
function play(tool, left = 60) {
  const run = spawnSync(player, [output, '-q', '--trajectory', way, '--record', record, ...(tool.tags ? ['--tags', input] : []), '--json', '-'], { encoding: 'utf8' });
  if (run.status === 3) return { refusal: run.stderr.trim().split(': ').pop() };
  if (run.status !== 0) throw new Error(run.stderr.trim());
  const report = JSON.parse(run.stdout);
  if (report.pauses.count > 0) {
    if (left === 0) throw new Error('the machine paused the player in every run');
    return play(tool, left - 1);
  }
  return { report, forces: forcesOf(readFileSync(record, 'utf8')) };
}

const percent = (x) => (x === undefined ? '-' : `${(100 * x).toFixed(2)} %`);
let reference = null, failures = 0;
const rows = [];
for (const tool of tools) {
  if (tool.needsBlender && !hasBlender) {
    console.log(`skip ${tool.name}: Blender is not installed`);
    continue;
  }
  rmSync(output, { force: true });
  let row = { tool: tool.name };
  const wrong = [];
  const expect = (what, is, wanted) => { if (is !== wanted) wrong.push(`${what} ${is}, not ${wanted}`); };
  try {
    tool.make();
    const { refusal, report, forces } = play(tool);
    if (refusal) {
      row = { ...row, kept: 0, restored: 0, note: refusal };
      expect('refused', true, tool.refused ?? false);
    } else {
      expect('refused', false, tool.refused ?? false);
      reference ??= forces;
      const difference = differences(reference, forces);
      row.restored = report.tags.restored.length;
      row.kept = report.materials.length - row.restored;
      row.maps = report.height_maps.loaded;
      row.smooth = Math.max(...difference.filter((_, i) => !felt[i].relief));
      row.relief = Math.max(...difference.filter((_, i) => felt[i].relief));
      row.note = [...new Set(report.warnings.map((w) => w.code))].join(', ');
      expect('kept', row.kept, tool.kept);
      expect('restored', row.restored, tool.restored ?? 0);
      expect('lost', report.tags.lost.length, 0);
      expect('contacts lost', report.lost_contact_ticks, 0);
      if (!(row.smooth <= tool.worst)) wrong.push(`force off by ${row.smooth}`);
      if (!tool.reliefLost && !(row.relief <= tool.worst)) wrong.push(`force on reliefs off by ${row.relief}`);
    }
  } catch (error) {
    row.note = error.message.split('\n').slice(0, 2).join(' ');
    wrong.push('failed');
  }
  failures += wrong.length > 0;
  rows.push({ ...row, holds: wrong.length === 0 });
  console.log(`${wrong.length ? 'FAIL' : 'ok  '} ${tool.name}: ${row.kept} kept, ${row.restored} restored, ${row.maps ?? '-'} maps, smooth ${percent(row.smooth)}, relief ${percent(row.relief)} (${row.note}) ${wrong.join('; ')}`);
}
rmSync(folder, { recursive: true });

const line = (cells) => `| ${cells.join(' | ')} |\n`;
const table = (columns, cells) => line(columns) + line(columns.map(() => '---')) + cells.map(line).join('');
const versions = JSON.parse(readFileSync(join(here, 'package.json'), 'utf8')).dependencies;
writeFileSync(evidence, `# What other tools leave of haptic tags

Written by \`ctest -R player.survival\` on ${new Date().toISOString()}, with gltf-transform ${versions['@gltf-transform/cli']}, gltfpack ${versions.gltfpack}, three.js ${versions.three}${hasBlender ? ` and ${spawnSync('blender', ['--version'], { encoding: 'utf8' }).stdout.split('\n')[0]}` : '; Blender was not installed'}.

## Targets

${table(['target', 'measured', 'holds'], rows.map((row) => [`after ${row.tool}: tags and forces as the test expects`, `${row.kept ?? 0} tags kept, ${row.restored ?? 0} found again of ${all}`, row.holds ? 'yes' : 'no']))}
## Tags and forces

${all} tagged plates and one without tag, three with relief, go through each tool with its defaults. The player strokes every plate of what comes out. Force: root mean square of the difference to the file as it was, over that of the force, of the plate where it is largest; smooth plates and those with relief apart. [survival.md](../survival.md) says what to do.

${table(['tool', 'tags kept', 'found again', 'reliefs', 'force, smooth', 'force, relief', 'warnings of the player'], rows.map((row) => [row.tool, row.kept ?? 0, row.restored ?? 0, row.maps ?? 0, percent(row.smooth), percent(row.relief), row.note ?? '']))}`);
process.exit(failures === 0 ? 0 : 1);
