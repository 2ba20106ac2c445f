// SPDX-License-Identifier: MIT
// Writes docs/evidence/README.md from the pages beside it: node evidence_index.mjs DOCS [--check]
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { anchorOf, firstParagraph, headings, tableAfter } from './markdown.mjs';

const [docs, mode] = process.argv.slice(2);
const INDEX = join(docs, 'evidence', 'README.md');

/** What the last column of targets may say: anything else would be counted nowhere. */
const VERDICTS = ['yes', 'no', 'not measured'];

/** What a promise must speak of to count for stability; all others are of error and run time. */
const STABILITY = /bad input|refus|finite|\bnan\b|crash|hang|stable|stability|stiff|extreme|needle|sliver|valid|flip|overlap|lost|never|\bnoise\b|manifold|degenerate|whatever/i;

/** Sections of an evidence page that are about stability as a whole. */
const STABLE_SECTION = /stab|bad|extreme|reject/i;

/** What other pages say of limits. */
const LIMIT_SECTION = /limit|left out|leave|lost|not shown|breaks down|what is not|losses/i;

const list = (folder) => readdirSync(folder).filter((name) => name.endsWith('.md') && name !== 'README.md').sort();

function evidencePage(name) {
  const text = readFileSync(join(docs, 'evidence', name), 'utf8');
  const [title] = headings(text);
  const written = /^Written by (`[^`]+`)(?: on (\d{4}-\d\d-\d\d)[^,]*)?(?:, commit ([0-9a-f]+(?:-dirty)?))?/m.exec(text) ?? [];
  const rows = tableAfter(text, 'Targets') ?? [];
  const promises = rows.map(([promise, measured, holds]) => ({ page: name, promise, measured, holds: holds.replaceAll('*', '') }));
  for (const { promise, holds } of promises)
    if (!VERDICTS.includes(holds)) throw new Error(`${name}: '${promise}' holds '${holds}'; it has to be one of ${VERDICTS.join(', ')}`);
  return { name, text, title: title.text.replace(/: what was measured$/, ''), day: written[2], commit: written[3], promises, ratios: tableAfter(text, 'Ratios') ?? [] };
}

const link = (page) => `[${page.name.replace(/\.md$/, '')}](${page.name})`;
const count = (promises, holds) => promises.filter((p) => p.holds === holds).length;
const row = (cells) => `| ${cells.join(' | ')} |\n`;
const table = (columns, rows) => rows.length ? `${row(columns)}${row(columns.map(() => '---'))}${rows.map(row).join('')}\n` : 'None.\n\n';

function overview(pages) {
  const all = pages.flatMap((p) => p.promises);
  const line = (name, promises, more) => [name, ...more, promises.length, count(promises, 'yes'), count(promises, 'no'), count(promises, 'not measured')];
  const rows = pages.filter((p) => p.promises.length).map((p) => line(`[${p.title}](${p.name})`, p.promises, [p.day ?? '–', p.commit ?? '–']));
  return table(['page', 'measured on', 'commit', 'promises', 'held', 'missed', 'not measured'], [...rows, line('**all**', all, ['', ''])]);
}

const missed = (promises) => table(['page', 'promise', 'measured'],
  promises.filter((p) => p.holds === 'no').map((p) => [`[${p.page.replace(/\.md$/, '')}](${p.page}#targets)`, p.promise, p.measured]));

const heldOf = (promises) => `${count(promises, 'yes')} of ${promises.length} promises hold, ${count(promises, 'no')} do not, ${count(promises, 'not measured')} could not be measured where the pages were written.`;

/** Our time or memory over the peer's, over all inputs. */
function ratios(pages) {
  const groups = new Map();
  for (const page of pages)
    for (const [method, peer, , quantity, ratio] of page.ratios) {
      const key = JSON.stringify([page.name, method, peer, quantity]);
      groups.set(key, [...(groups.get(key) ?? []), Number(ratio)]);
    }
  const short = (x) => String(Number(x.toPrecision(3)));
  return table(['page', 'method', 'peer', 'quantity', 'inputs', 'least', 'median', 'most'], [...groups].map(([key, values]) => {
    const [name, method, peer, quantity] = JSON.parse(key), sorted = values.sort((a, b) => a - b);
    return [`[${name.replace(/\.md$/, '')}](${name}#ratios)`, method, peer, quantity, sorted.length, short(sorted[0]), short(sorted[sorted.length >> 1]), short(sorted.at(-1))];
  }));
}

function curves() {
  const methods = list(join(docs, 'methods'));
  return `Every method has a page with its formula, its limits and, on the built site (\`./run docs\`), its error over run time: [methods](../methods/README.md) (${methods.length}). \`papilla evaluate\` draws the same on your input.\n\n`;
}

const EXTREMES = '- [stability](../stability.md): every method on input that was made to break it, counted by suite; `./run stability` makes the tables\n';

function stableTables(pages) {
  const rows = pages.flatMap((page) => headings(page.text).filter((h) => h.level === 2 && STABLE_SECTION.test(h.text)).map((h) => {
    const lines = tableAfter(page.text, h.text) ?? [];
    return [`[${page.title}: ${h.text}](${page.name}#${anchorOf(h.text)})`, lines.length];
  }));
  const whole = pages.filter((p) => !p.promises.length).map((p) => `- ${link(p)}: ${firstParagraph(p.text).replace(/\n/g, ' ')}\n`).join('');
  return `${EXTREMES}${whole}\n${table(['table', 'rows'], rows)}`;
}

/** Links of a page of docs/ as they are from docs/evidence. */
function linksFrom(page, text) {
  return text.replace(/\]\((?![a-z]+:)([^)#]*)/g, (_, target) => `](${relative('evidence', target ? join(dirname(page), target) : page)}`);
}

function limits() {
  const ofMethods = list(join(docs, 'methods')).map((name) => {
    const text = readFileSync(join(docs, 'methods', name), 'utf8');
    return [`[${headings(text)[0].text}](../methods/${name}#limits)`, linksFrom(`methods/${name}`, firstParagraph(text, 'Limits')).replace(/\n/g, ' ')];
  });
  const ofPages = list(docs).flatMap((name) => headings(readFileSync(join(docs, name), 'utf8'))
    .filter((h) => h.level > 1 && LIMIT_SECTION.test(h.text)).map((h) => `- [${name.replace(/\.md$/, '')}: ${h.text}](../${name}#${anchorOf(h.text)})\n`));
  const inWords = list(docs).flatMap((name) => readFileSync(join(docs, name), 'utf8').split('\n\n').filter((p) => p.startsWith('Limits: '))
    .map((p) => `- [${name.replace(/\.md$/, '')}](../${name}): ${linksFrom(name, p.slice(8)).replaceAll('\n', ' ')}\n`));
  return `${table(['method', 'where it breaks down'], ofMethods)}${inWords.join('')}${ofPages.join('')}\n`;
}

function index() {
  const pages = list(join(docs, 'evidence')).map(evidencePage), promises = pages.flatMap((p) => p.promises);
  const ofStability = promises.filter((p) => STABILITY.test(p.promise)), others = promises.filter((p) => !STABILITY.test(p.promise));
  const open = promises.filter((p) => p.holds === 'not measured');
  return `# Evidence: what error for what run time, is it stable, what is left out

Written by \`./run evidence-index\` from the pages in this folder, which the benchmarks and tests write (\`./run bench NAME --evidence FILE\`), and from
the limits that the method pages name. A promise counts for stability when its words are of validity, noise or extreme input, else for error and run time.

${overview(pages)}## What error for what run time?

${heldOf(others)} ${curves()}Missed:

${missed(others)}Against named peers in the same run, ours over theirs; below 1 is better:

${ratios(pages)}## Does it stay stable on stiff and extreme input?

${heldOf(ofStability)} Missed:

${missed(ofStability)}Where each method holds and where it breaks, row by row:

${stableTables(pages)}## What is left out?

Not measured where these pages were written, for want of the peer, the device or the file:

${table(['page', 'promise', 'why'], open.map((p) => [`[${p.page.replace(/\.md$/, '')}](${p.page}#targets)`, p.promise, p.measured]))}Where the methods stop being right:

${limits()}`.replace(/\n+$/, '\n');
}

const page = index();
if (mode === '--check') {
  if (readFileSync(INDEX, 'utf8') !== page) {
    console.error('docs/evidence/README.md is older than the pages it sums up: ./run evidence-index');
    process.exit(1);
  }
} else writeFileSync(INDEX, page);
