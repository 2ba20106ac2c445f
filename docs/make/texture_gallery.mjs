// SPDX-License-Identifier: MIT
// Photographs with their lattice, the relief found and the true one, and what a single one does not tell:
//   node texture_gallery.mjs BIN DOCS [PICTURE ...]
// Without PICTURE the program photographs reliefs of its own and writes docs/evidence/texture-gallery.md with its
// picture; with them it does the same for other photographs, into build/texture-gallery.
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';

const [bin, docs, ...given] = process.argv.slice(2);
const SIDE = 220, PX = 400;
const work = mkdtempSync(join(tmpdir(), 'papilla-gallery-'));
const papilla = (...args) => execFileSync(join(bin, 'papilla'), [...args, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
const json = (file) => JSON.parse(readFileSync(file, 'utf8'));

/** Reliefs: what is known of them, their height in mm on 40 mm, the light's azimuth. */
const OWN = [
  ['spheres8', 'square cells of 50 px', 0.3, 35], ['ovals6', 'rows of cells', 0.3, 120], ['quads8', 'square cells of 50 px', 0.3, 200],
  ['sine', 'two waves, cells of 35.4 px', 0.3, 300], ['fourier', 'no lattice, no power law', 1.5, 70], ['leather', 'no lattice', 0.3, 250],
];
const FRACTAL = { dimension: 2.3, height: 3, azimuth: 160 };

const lightAt = (azimuth) => {
  const a = azimuth * Math.PI / 180, up = Math.sin(40 * Math.PI / 180), flat = Math.cos(40 * Math.PI / 180);
  return [flat * Math.cos(a), flat * Math.sin(a), up].map((x) => x.toFixed(4)).join(',');
};

function photographOf(name, truth, azimuth, seed) {
  const file = join(work, `${name}.jpg`);
  papilla('synthesize', 'photo', truth, '-o', file, `--light=${lightAt(azimuth)}`, '--albedo-noise', '0.04', '--uneven-light', '0.1',
    '--vignette', '0.1', '--blur-px', '0.7', '--noise', '0.01', '--seed', String(seed));
  return file;
}

function ownPhotographs() {
  const reliefOf = (name, height, ...what) => {
    const truth = join(work, `${name}.exr`);
    papilla('synthesize', ...what, '--height-mm', String(height), '-o', join(work, `${name}-grey.png`), '--relief', truth);
    return truth;
  };
  const grains = OWN.map(([kind, known, height, azimuth], i) => {
    const truth = reliefOf(kind, height, 'grain', '--kind', kind, '--size', String(PX));
    return { name: kind, truth, azimuth, known, file: photographOf(kind, truth, azimuth, i + 1) };
  });
  const { dimension, height, azimuth } = FRACTAL;
  const truth = reliefOf('fractal', height, 'fractal', '--dimension', String(dimension), '--size', String(PX + 1));
  return [...grains, { name: 'fractal', truth, azimuth, known: `relief of D ${dimension}`, file: photographOf('fractal', truth, azimuth, grains.length + 1) }];
}

const otherPhotographs = () => given.map((file) => ({ name: basename(file), known: 'nothing', file }));

/** One row of the picture: photograph, lattice drawn, relief found lit, true relief lit. */
function panels(photo) {
  const out = join(work, `${photo.name}-report`);
  mkdirSync(out);
  papilla('analyze', photo.file, '--pitch', '0.1', '--pictures', join(out, 'lattice'), '--json', join(out, 'analysis.json'));
  papilla('height', photo.file, '--pitch', '0.1', '-o', join(out, 'found.exr'), '--pictures', join(out, 'found'), '--json', join(out, 'height.json'));
  const row = [photo.file, join(out, 'lattice', 'symmetry.png'), join(out, 'found', 'relief.png')];
  if (photo.truth) {
    papilla('height', photo.truth, '--method', 'intensity', '--transfer', 'linear', '--pitch', '0.1', '-o', join(out, 'true.exr'), '--pictures', join(out, 'true'));
    row.push(join(out, 'true', 'relief.png'));
  }
  return { ...photo, row, analysis: json(join(out, 'analysis.json')), height: json(join(out, 'height.json')) };
}

function draw(photos, file) {
  const columns = Math.max(...photos.map((p) => p.row.length));
  const args = ['--pattern', 'constant:color=1,1,1', `${columns * SIDE}x${photos.length * SIDE}`, '3'];
  photos.forEach((photo, y) => photo.row.forEach((panel, x) => {
    const { width, height, channels } = sizeOf(panel);
    // The first panel of the strip, above a line of text, is the picture with its lattice.
    const [cutWidth, cutHeight] = x === 1 ? sideBySide(photo.file, height) : [width, height];
    args.push(panel, '--crop', `${cutWidth}x${cutHeight}+0+0`, '--fullpixels', '--ch', channels < 3 ? '0,0,0' : '0,1,2', '--fit', `${SIDE - 8}x${SIDE - 8}`, '--swap', '--paste', `+${x * SIDE + 4}+${y * SIDE + 4}`);
  }));
  execFileSync('oiiotool', [...args, '--compression', 'jpeg:88', '-d', 'uint8', '-o', file], { stdio: 'inherit' });
}

function sizeOf(file) {
  const [, width, height, channels] = /(\d+) x +(\d+), (\d+) channel/.exec(execFileSync('oiiotool', ['--info', file], { encoding: 'utf8' })).map(Number);
  return { width, height, channels };
}

/** The size of a picture as it stands in a strip of that height at most. */
function sideBySide(file, most) {
  const { width, height } = sizeOf(file), scale = Math.min(1, (most - 33) / height);
  return [Math.round(width * scale), Math.round(height * scale)];
}

const vector = ([x, y]) => `(${x.toFixed(1)}, ${y.toFixed(1)})`;

function latticeOf(analysis) {
  const s = analysis.symmetry ?? {};
  return s.lattice ? `${s.vectors_px.map(vector).join(' ')} ${s.group ?? ''}` : 'none';
}

function dimensionOf({ fractal }) {
  const best = fractal.best;
  return best.power_law ? `${best.dimension.toFixed(2)} [${best.low.toFixed(2)}, ${best.high.toFixed(2)}]` : `none: ${best.reason}`;
}

function lightOf({ height, azimuth }) {
  if (!height.light_estimated) return 'not used';
  const found = Math.atan2(height.light[1], height.light[0]) * 180 / Math.PI;
  const said = `${((found + 360) % 360).toFixed(0)}° ± ${height.light_uncertainty_deg.toFixed(0)}°, or its opposite`;
  return azimuth === undefined ? said : `${said} (true ${azimuth}°)`;
}

const rowOf = (photo) => [photo.name, photo.known, latticeOf(photo.analysis), dimensionOf(photo.analysis), lightOf(photo),
  photo.height.method, photo.height.expected_correlation?.toFixed(2) ?? 'not known', [...new Set(photo.height.assumed)].join('; ')];

function page(photos, picture) {
  const head = ['photograph', 'known', 'lattice [px], group', 'D and its 95 % interval', 'light from', 'relief by', 'expected correlation', 'can\'t be known from one photograph'];
  const line = (cells) => `| ${cells.join(' | ')} |\n`;
  return `# Photographs, what is found in them and what is not

Written by \`node docs/make/texture_gallery.mjs\`. From the left: the photograph; the lattice drawn on it; the relief found from this one photograph, lit
from the upper left; the true relief, lit the same way. Photographs by the program of its own reliefs under light from many sides, elevation 40°, with
spots of 4 %, uneven light of 10 %, vignette of 10 %, a point spread of 0.7 pixels, noise of 1 %, as JPEG. Errors over many such photographs are in
[texture](texture.md). For photographs of your own: \`node docs/make/texture_gallery.mjs build/release/bin docs PICTURE ...\`.

![photograph, lattice, relief found, true relief](${picture})

${line(head)}${line(head.map(() => '---'))}${photos.map((p) => line(rowOf(p))).join('')}`;
}

const photos = (given.length ? otherPhotographs() : ownPhotographs()).map(panels);
if (given.length) {
  mkdirSync('build/texture-gallery', { recursive: true });
  draw(photos, 'build/texture-gallery/gallery.jpg');
  writeFileSync('build/texture-gallery/gallery.md', page(photos, 'gallery.jpg'));
} else {
  draw(photos, join(docs, 'pictures', 'texture-gallery.jpg'));
  writeFileSync(join(docs, 'evidence', 'texture-gallery.md'), page(photos, '../pictures/texture-gallery.jpg'));
}
rmSync(work, { recursive: true });
