// SPDX-License-Identifier: MIT
// Elements from data. Text is always text: nothing of the data is parsed as markup.
export function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'class') node.className = value;
    else node.setAttribute(key, value);
  }
  node.append(...children.map((child) => child instanceof Node ? child : String(child)));
  return node;
}

/** @param columns [{title, of, numeric}] */
export function table(columns, rows, onRow) {
  const head = element('tr', {}, ...columns.map((c) => element('th', c.numeric ? { class: 'n', scope: 'col' } : { scope: 'col' }, c.title)));
  const body = rows.map((row) => {
    const line = element('tr', {}, ...columns.map((c) => {
      const value = c.of(row);
      return element('td', c.numeric ? { class: 'n' } : {}, value);
    }));
    if (onRow) line.addEventListener('click', () => onRow(row));
    return line;
  });
  return element('div', { class: 'table', tabindex: '0' }, element('table', {}, element('thead', {}, head), element('tbody', {}, ...body)));
}

export function csvOf(columns, rows) {
  const cell = (value) => /[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value);
  return [columns.map((c) => c.title), ...rows.map((row) => columns.map((c) => c.text ? c.text(row) : c.of(row)))].map((line) => line.map(cell).join(',')).join('\n') + '\n';
}

export function download(name, text, type) {
  const link = element('a', { href: URL.createObjectURL(new Blob([text], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** "1 part", "1,200 parts". */
export const count = (n, what) => `${n.toLocaleString('en')} ${what}${n === 1 ? '' : 's'}`;
