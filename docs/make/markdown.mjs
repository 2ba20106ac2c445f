// SPDX-License-Identifier: MIT
// The little of Markdown that the pages of this project use.

/** Headings outside of code: [{level, text, line}]. */
export function headings(text) {
  const found = [];
  let code = false;
  text.split('\n').forEach((line, i) => {
    if (line.startsWith('```')) code = !code;
    const head = !code && /^(#+) (.+)$/.exec(line);
    if (head) found.push({ level: head[1].length, text: head[2], line: i });
  });
  return found;
}

/** The lines of the section with that heading, or of the whole page; without further headings. */
function section(text, title) {
  const lines = text.split('\n'), heads = headings(text);
  const at = title === undefined ? 0 : heads.findIndex((h) => h.text === title);
  if (at < 0 || !heads.length) return [];
  return lines.slice(heads[at].line + 1, heads[at + 1]?.line);
}

const cellsOf = (line) => line.slice(1, line.lastIndexOf('|')).split(/(?<!\\)\|/).map((cell) => cell.trim());

/** The rows of the first table of a section, without its head; null when it has none. */
export function tableAfter(text, title) {
  const lines = section(text, title);
  const first = lines.findIndex((line) => line.startsWith('|'));
  if (first < 0) return null;
  const rest = lines.slice(first), end = rest.findIndex((line) => !line.startsWith('|'));
  return rest.slice(2, end < 0 ? undefined : end).map(cellsOf);
}

/** The first paragraph of a section. */
export function firstParagraph(text, title) {
  const lines = section(text, title), first = lines.findIndex((line) => line.trim());
  if (first < 0) return '';
  const rest = lines.slice(first), end = rest.findIndex((line) => !line.trim());
  return rest.slice(0, end < 0 ? undefined : end).join('\n');
}

/** The anchor that GitHub and mkdocs give a heading. */
export const anchorOf = (heading) => heading.toLowerCase().replace(/[^\w\s-]/g, '').trim().replace(/\s+/g, '-');
