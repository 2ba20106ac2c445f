// SPDX-License-Identifier: MIT
// Bundles the pages of src/ with their libraries into one HTML file each and writes these as C++:
// node build.mjs NODE_MODULES PAGE.cpp STUDIO.cpp
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [modules, output, studio] = process.argv.slice(2).map((path) => resolve(path));
const folder = join(dirname(fileURLToPath(import.meta.url)), 'src');
const { build } = createRequire(join(modules, 'x'))('esbuild');

async function bundle(entry, loader) {
  const result = await build({
    entryPoints: [join(folder, entry)], bundle: true, minify: true, write: false, nodePaths: [modules],
    format: 'iife', target: ['chrome110', 'firefox115'], loader, legalComments: 'none', charset: 'utf8',
  });
  return result.outputFiles[0].text;
}

const licences = ['three', 'three-mesh-bvh', 'uplot', 'meshoptimizer', 'fast-png', 'fflate', 'iobuffer'].map((name) => {
  const about = JSON.parse(readFileSync(join(modules, name, 'package.json'), 'utf8'));
  return `${name} ${about.version} (${about.license})`;
});

/** One line of C++: a string literal of the UTF-8 bytes. */
function literal(line) {
  let text = '';
  for (const byte of Buffer.from(line, 'utf8')) {
    const plain = byte >= 32 && byte < 127 && byte !== 34 && byte !== 92 && byte !== 63;
    text += plain ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, '0')}`;
  }
  return `    "${text}"`;
}

/** One page: its bundle put into its HTML, and that into a function of C++ of the header. */
async function write(page, { html: file, script, style, markers, header, name }) {
  const parts = { STYLE: await bundle(style, {}), SCRIPT: await bundle(script, {}), LICENCES: licences.join(', ') };
  const html = readFileSync(join(folder, file), 'utf8').replace(/@(STYLE|SCRIPT|LICENCES)@/g, (_, part) => parts[part]);
  for (const marker of markers) if (html.split(marker).length !== 2) throw new Error(`the bundle must hold ${marker} once`);
  const chunks = html.match(/[^]{1,4000}/gu);
  writeFileSync(page, `// SPDX-License-Identifier: GPL-3.0-or-later
// Made by page/build.mjs.
#include "${header}"

std::string_view papilla::app::${name}() noexcept {
  static constexpr char text[] =
${chunks.map(literal).join('\n')};
  return {text, sizeof(text) - 1};
}
`);
  writeFileSync(page.replace(/\.cpp$/, '.html'), html);
}

await write(output, {
  html: 'index.html', script: 'main.mjs', style: 'style.css', markers: ['@PAPILLA_CONNECT@', '@PAPILLA_DATA@'],
  header: 'page/page_file.hpp', name: 'page_template',
});
await write(studio, {
  html: 'studio/studio.html', script: 'studio/main.mjs', style: 'studio/studio.css', markers: ['@PAPILLA_DATA@'],
  header: 'studio/studio_session.hpp', name: 'studio_template',
});
