// SPDX-License-Identifier: MIT
// Copies the pages of the project for mkdocs, with pictures and curves where the pages ask for them:
//   node pages.mjs PROJECT RUNS OUT
//   <!-- picture FILE, CAPTION -->          a picture of the runs
//   <!-- curve JSON METHOD [VARIANT] -->    error over run time of a method, all others of the file behind it
//   <!-- stroke CSV,… force|depth|travel, CAPTION -->  recordings of the player
//   <!-- table CSV -->                      the whole file
//   <!-- tables MD -->                      a page of the runs without its title and first paragraph
// A page below methods/ that lacks its formula, a picture, a curve, its limits or its source is an error.
import { copyFileSync, cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, extname, join, relative } from 'node:path';
import { drawEvaluation, drawStroke } from './curve.mjs';
import { readCsv } from './csv.mjs';

const [project, runs, out] = process.argv.slice(2);

class PageMaker {
  /** @param page path below docs/ */
  constructor(page) {
    this.folder = join(out, dirname(page));
    this.stem = basename(page, '.md');
    mkdirSync(join(this.folder, 'pictures'), { recursive: true });
  }

  place(ending) {
    this.count = (this.count ?? 0) + 1;
    return join('pictures', `${this.stem}-${this.count}${ending}`);
  }

  picture(text) {
    const [, file, caption] = /^(\S+), (.*)$/.exec(text), name = this.place(extname(file));
    copyFileSync(join(runs, file), join(this.folder, name));
    return `![${caption}](${name})\n\n*${caption}*`;
  }

  curve(text) {
    const [file, method, ...variant] = text.split(' '), name = this.place('.svg');
    const { error, input, others, dots } = drawEvaluation(join(runs, file), join(this.folder, name), method, variant.join(' '));
    return `![Error over run time](${name})\n\n*${error} over run time on ${input}${dots ? '; a direct method is a dot' : ''}${others ? '; grey: all others of the same run' : ''}.*`;
  }

  stroke(text) {
    const [, files, what, caption] = /^(\S+) (\w+), (.*)$/.exec(text), name = this.place('.svg');
    drawStroke(files.split(',').map((file) => join(runs, file)), join(this.folder, name), what);
    return `![${caption}](${name})\n\n*${caption}*`;
  }

  table(text) {
    const rows = readCsv(join(runs, text)), names = Object.keys(rows[0]);
    return [names, names.map(() => '---'), ...rows.map((r) => names.map((n) => r[n]))].map((cells) => `| ${cells.join(' | ')} |`).join('\n');
  }

  tables(text) {
    const page = readFileSync(join(runs, text), 'utf8');
    return page.slice(page.indexOf('\n## ') + 1);
  }

  filled(text) {
    return text.replace(/^<!-- (picture|curve|stroke|tables?) (.*) -->$/gm, (_, kind, what) => this[kind](what));
  }
}

/** Links out of docs/ lead to copies; what is no page has no link. */
function linksOf(text, page) {
  return text.replace(/\]\(([^)#\s]+)(#[^)]*)?\)/g, (all, target, anchor = '') => {
    if (/^[a-z]+:/.test(target)) return all;
    const path = relative(join(project, 'docs'), join(project, 'docs', dirname(page), target));
    if (!path.startsWith('..')) return target.endsWith('/') ? `](${target}README.md${anchor})` : all;
    const copy = { '../README.md': 'project.md', '../CONTRIBUTING.md': 'contributing.md', '../CHANGELOG.md': 'changes.md' }[path];
    return copy ? `](${relative(dirname(page), copy)}${anchor})` : ']()';
  }).replace(/\[([^\]]*)\]\(\)/g, '$1');
}

/** What a method page has to have and has not. */
function missing(text) {
  const asks = (...kinds) => kinds.some((kind) => text.includes(`\n<!-- ${kind} `));
  return [...['Formula', 'Limits', 'Source'].filter((title) => !text.includes(`\n## ${title}\n`)),
    ...(asks('picture', 'stroke') ? [] : ['a picture']), ...(asks('curve') ? [] : ['a curve'])];
}

rmSync(out, { recursive: true, force: true });
for (const folder of ['.', 'methods', 'evidence']) {
  for (const name of readdirSync(join(project, 'docs', folder)).filter((n) => n.endsWith('.md'))) {
    const page = join(folder, name), text = readFileSync(join(project, 'docs', page), 'utf8');
    const lacks = folder === 'methods' && name !== 'README.md' ? missing(text) : [];
    if (lacks.length) throw new Error(`docs/${page}: lacks ${lacks.join(', ')}`);
    const maker = new PageMaker(page);
    writeFileSync(join(out, page), linksOf(maker.filled(text), page));
  }
}
cpSync(join(project, 'docs', 'pictures'), join(out, 'pictures'), { recursive: true });
for (const name of readdirSync(join(project, 'docs', 'evidence')).filter((n) => !n.endsWith('.md')))
  copyFileSync(join(project, 'docs', 'evidence', name), join(out, 'evidence', name));
for (const [name, copy] of [['README.md', 'project.md'], ['CONTRIBUTING.md', 'contributing.md'], ['CHANGELOG.md', 'changes.md']])
  writeFileSync(join(out, copy), readFileSync(join(project, name), 'utf8')
    .replace(/\]\(docs\/([^)]*)\)/g, '](./$1)').replace(/\]\((?!\.\/|https?:)[^)]*\)/g, ']()').replace(/\[([^\]]*)\]\(\)/g, '$1'));
