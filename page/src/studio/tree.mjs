// SPDX-License-Identifier: MIT
// Parts by assembly: an ARIA tree with search and multiple selection.
import { element } from '../dom.mjs';

const MOST_FOUND = 500;

export class Tree {
  /** @param onSelect(keys, add) @param onDrop(keys, event) */
  constructor(host, onSelect, onDrop) {
    Object.assign(this, { host, onSelect, onDrop, open: new Set(['']), rows: [], at: 0, selected: new Set(), hidden: new Set() });
    host.addEventListener('keydown', (e) => this.key(e));
    host.addEventListener('click', (e) => this.click(e));
  }

  /** @param uses [{path, part}] @param keysOf(use number) the surfaces of a use: [{key, label}] */
  fill(uses, keysOf) {
    this.root = { name: '', path: '', children: new Map(), keys: [] };
    uses.forEach((use, number) => {
      let node = this.root;
      for (const name of use.path.split('/')) {
        if (!node.children.has(name)) node.children.set(name, { name, path: `${node.path}/${name}`, children: new Map(), keys: [] });
        node = node.children.get(name);
      }
      for (const { key, label } of keysOf(number)) node.keys.push({ key, label });
    });
    for (const child of this.root.children.values()) this.open.add(child.path);
    this.draw();
  }

  find(words) { this.words = words.trim().toLowerCase().split(/\s+/).filter(Boolean); this.draw(); }
  mark(selected, hidden) { Object.assign(this, { selected, hidden }); this.paint(); }

  allKeys(node) { return [...node.keys.map((k) => k.key), ...[...node.children.values()].flatMap((child) => this.allKeys(child))]; }

  *visible(node, level) {
    for (const child of node.children.values()) {
      const several = child.keys.length > 1, leaf = !child.children.size && !several;
      const matches = !this.words?.length || this.words.every((word) => child.path.toLowerCase().includes(word));
      const opened = this.words?.length ? true : this.open.has(child.path);
      if (matches || !leaf) yield { node: child, level, leaf, opened, keys: this.allKeys(child), hit: matches };
      if (leaf || !opened) continue;
      if (several) for (const { key, label } of child.keys) yield { node: { name: label.split('/').pop(), path: `${child.path}#${key}` }, level: level + 1, leaf: true, keys: [key], hit: matches };
      yield* this.visible(child, level + 1);
    }
  }

  draw() {
    const rows = [...this.visible(this.root, 1)];
    this.rows = this.words?.length ? rows.filter((row) => row.leaf && row.hit).slice(0, MOST_FOUND) : rows;
    this.at = Math.min(this.at, Math.max(this.rows.length - 1, 0));
    this.host.replaceChildren(...this.rows.map((row, i) => {
      const item = element('div', { role: 'treeitem', 'aria-level': String(row.level), id: `tree-${i}`, tabindex: i === this.at ? '0' : '-1', title: row.node.path.slice(1) }, row.node.name);
      item.style.setProperty('--level', this.words?.length ? 1 : row.level);
      if (!row.leaf) item.setAttribute('aria-expanded', String(row.opened));
      for (const name of ['dragover', 'drop']) item.addEventListener(name, (e) => this.onDrop(row.keys, e));
      return item;
    }));
    this.paint();
  }

  paint() {
    [...this.host.children].forEach((item, i) => {
      const { keys } = this.rows[i];
      item.setAttribute('aria-selected', String(keys.length > 0 && keys.every((key) => this.selected.has(key))));
      item.classList.toggle('hidden-part', keys.length > 0 && keys.every((key) => this.hidden.has(key)));
    });
  }

  /** Brings a surface into sight. */
  reveal(key) {
    const i = this.rows.findIndex((row) => row.leaf && row.keys.includes(key));
    if (i >= 0) this.host.children[i].scrollIntoView({ block: 'nearest' });
  }

  click(event) {
    const i = [...this.host.children].indexOf(event.target.closest('[role=treeitem]'));
    if (i < 0) return;
    const row = this.rows[i], onMark = !row.leaf && event.offsetX < 14 + 12 * row.level;
    this.focus(i);
    if (onMark) this.toggle(row);
    else this.onSelect(row.keys, event.ctrlKey || event.metaKey || event.shiftKey);
  }

  toggle(row, open = !this.open.has(row.node.path)) {
    if (open) this.open.add(row.node.path); else this.open.delete(row.node.path);
    this.draw();
    this.focus(this.at);
  }

  focus(i) {
    this.host.children[this.at]?.setAttribute('tabindex', '-1');
    this.at = Math.min(Math.max(i, 0), this.rows.length - 1);
    this.host.children[this.at]?.setAttribute('tabindex', '0');
    this.host.children[this.at]?.focus();
  }

  key(event) {
    const row = this.rows[this.at];
    if (!row) return;
    const act = {
      ArrowDown: () => this.focus(this.at + 1), ArrowUp: () => this.focus(this.at - 1), Home: () => this.focus(0), End: () => this.focus(this.rows.length - 1),
      ArrowRight: () => row.leaf || row.opened ? this.focus(this.at + 1) : this.toggle(row, true),
      ArrowLeft: () => row.leaf || !row.opened ? this.focus(this.rows.findLastIndex((other, i) => i < this.at && other.level < row.level)) : this.toggle(row, false),
      Enter: () => this.onSelect(row.keys, event.ctrlKey || event.metaKey), ' ': () => this.onSelect(row.keys, true),
    }[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }
}
