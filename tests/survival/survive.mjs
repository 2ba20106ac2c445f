// SPDX-License-Identifier: MIT
// Sends a file with haptic tags through the tools that glTF files meet, and lets the player feel what comes out.
// usage: node survive.mjs PLAYER PLATE_MAKER [REPORT.json]; exit code 77 when the tools are not installed (npm ci).
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const [player, makePlate, reportFile] = process.argv.slice(2);
if (!makePlate) {
  console.error('usage: node survive.mjs PLAYER PLATE_MAKER [REPORT.json]');
  process.exit(2);
}

let core, extensions, functions, draco, gltfpackPath, three;
try {
  core = await import('@gltf-transform/core');
  extensions = await import('@gltf-transform/extensions');
  functions = await import('@gltf-transform/functions');
  draco = (await import('draco3dgltf')).default;
  gltfpackPath = new URL('./node_modules/gltfpack/cli.js', import.meta.url).pathname;
  readFileSync(gltfpackPath);
  globalThis.self = globalThis;
  globalThis.ProgressEvent ??= class {};
  globalThis.FileReader ??= class {
    readAsArrayBuffer(blob) {
      blob.arrayBuffer().then((buffer) => {
        this.result = buffer;
        this.onloadend?.();
      });
    }
  };
  three = {
    ...(await import('three/examples/jsm/loaders/GLTFLoader.js')),
    ...(await import('three/examples/jsm/exporters/GLTFExporter.js')),
  };
} catch (error) {
  console.log(`skipped: ${error.message.split('\n')[0]}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), 'papilla-survival-'));
const input = join(folder, 'in.glb');
execFileSync(makePlate, [input, 'relief']);

const io = new core.NodeIO().registerExtensions(extensions.ALL_EXTENSIONS).registerDependencies({
  'draco3d.decoder': await draco.createDecoderModule(),
  'draco3d.encoder': await draco.createEncoderModule(),
});
const transformed = (...steps) => async (output) => {
  const document = await io.read(input);
  document.setLogger(new core.Logger(core.Logger.Verbosity.SILENT));
  await document.transform(...steps);
  await io.write(output, document);
};
const packed = (...options) => async (output) => {
  execFileSync('node', [gltfpackPath, '-i', input, '-o', output, ...options], {stdio: 'pipe'});
};
// Without a browser three.js reads no pictures; what is looked at is the material.
const exported = async (output) => {
  const warn = console.warn, fail = console.error;
  console.warn = console.error = () => {};
  const bytes = readFileSync(input);
  const gltf = await new three.GLTFLoader().parseAsync(
    bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
  gltf.scene.traverse((object) => {
    if (object.material) object.material.normalMap = null;
  });
  const result = await new three.GLTFExporter().parseAsync(gltf.scene, {binary: true});
  console.warn = warn;
  console.error = fail;
  writeFileSync(output, Buffer.from(result));
};

const tools = [
  ['as it was written', async (output) => writeFileSync(output, readFileSync(input))],
  ['glTF-Transform copy', transformed()],
  ['glTF-Transform prune', transformed(functions.prune())],
  ['glTF-Transform dedup', transformed(functions.dedup())],
  ['glTF-Transform weld', transformed(functions.weld())],
  ['glTF-Transform quantize', transformed(functions.quantize())],
  ['glTF-Transform draco', transformed(functions.draco())],
  ['gltfpack -ke', packed('-ke')],
  ['gltfpack -ke -noq', packed('-ke', '-noq')],
  ['gltfpack -ke -cc', packed('-ke', '-cc')],
  ['gltfpack (without -ke)', packed(), 'lost'],
  ['three.js GLTFLoader and GLTFExporter', exported],
];

const rows = [];
let failures = 0, reference = 0;
for (const [name, make, expected = 'kept'] of tools) {
  const output = join(folder, 'out.glb');
  rmSync(output, {force: true});
  let row;
  try {
    await make(output);
    const run = spawnSync(player, [output, '-q', '--seconds', '0.5', '--json', '-'], {encoding: 'utf8'});
    if (run.status === 3) {
      row = {tool: name, outcome: 'lost', detail: run.stderr.trim().split(': ').pop()};
    } else {
      const report = JSON.parse(run.stdout);
      reference ||= report.max_force_n;
      const kept = report.height_maps.loaded === 1 && report.lost_contact_ticks === 0 &&
        Math.abs(report.max_force_n / reference - 1) < 0.05;
      const codes = report.warnings.map((w) => w.code).join(', ');
      row = {tool: name, outcome: kept ? 'kept' : 'changed',
        detail: `${report.triangles} triangles, ${report.max_force_n.toFixed(3)} N${codes ? `, ${codes}` : ''}`};
    }
  } catch (error) {
    row = {tool: name, outcome: 'failed', detail: error.message.split('\n')[0]};
  }
  row.expected = expected;
  failures += row.outcome !== expected;
  rows.push(row);
  console.log(`${row.outcome === expected ? 'ok  ' : 'FAIL'} ${name}: ${row.outcome} (${row.detail})`);
}
rmSync(folder, {recursive: true});
if (reportFile) writeFileSync(reportFile, JSON.stringify(rows));
process.exit(failures === 0 ? 0 : 1);
