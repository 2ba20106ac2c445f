// SPDX-License-Identifier: MIT
// The materials of the document and of the library, to be dragged onto parts or applied with Enter.
import { element } from '../dom.mjs';
import { address } from './api.mjs';
import { PictureQueue } from './picture_queue.mjs';
import { T } from './texts.mjs';

/** What is dragged: {"material": name} or {"library": id}. */
export const DRAG_TYPE = 'application/x-papilla-material';

const fold = (text) => text.toLowerCase().replace(/ß/g, 'ss').normalize('NFD').replace(/[\u0300-\u036f]/g, '');

export class MaterialList {
  /** @param onApply({material} or {library}) */
  constructor(own, library, onApply) {
    Object.assign(this, { own, library, onApply, entries: [], pictures: new PictureQueue() });
    for (const host of [own, library]) host.addEventListener('keydown', (e) => this.key(e, host));
  }

  setDocument(materials) {
    const names = Object.keys(materials ?? {});
    const same = JSON.stringify(names);
    if (same === this.names) return;
    this.names = same;
    const items = [this.item({ material: null }, T.noMaterial, null), ...names.map((name) => this.item({ material: name }, name, materials[name]))];
    this.own.replaceChildren(...items);
    items[0].tabIndex = 0;
  }

  setLibrary(entries) {
    this.entries = entries;
    this.find('');
  }

  find(words) {
    const wanted = fold(words).split(/\s+/).filter(Boolean);
    const found = this.entries.filter((m) => {
      const text = fold([m.name, m.names.en, m.names.de, ...m.aliases, ...m.categories.en, ...m.categories.de].join(' '));
      return wanted.every((word) => text.includes(word));
    });
    this.library.replaceChildren(...found.map((m) => this.item({ library: m.name }, m.names.en, m)));
    if (this.library.firstChild) this.library.firstChild.tabIndex = 0;
  }

  item(what, title, about) {
    const swatch = element('span', { class: 'swatch', 'aria-hidden': 'true' });
    const colour = about?.appearance?.color ?? about?.color;
    if (colour) swatch.style.background = colour;
    const shown = what.library ?? /^library:(.+)$/.exec(about?.material ?? '')?.[1];
    if (shown) {
      const picture = element('img', { alt: '', 'data-src': address('library-picture', { id: shown }), draggable: 'false' });
      swatch.append(picture);
      picture.addEventListener('error', () => picture.remove());
      this.pictures.add(picture);
    }
    const item = element('div', { role: 'option', tabindex: '-1', draggable: 'true', class: 'material', 'aria-selected': 'false', title: `${what.library ? `library:${what.library}` : title}` }, swatch, element('span', {}, title));
    item.dataset.material = what.library ? `library:${what.library}` : what.material ?? '';
    item.addEventListener('dragstart', (e) => {
      e.dataTransfer.setData(DRAG_TYPE, JSON.stringify(what));
      e.dataTransfer.effectAllowed = 'copy';
    });
    item.addEventListener('click', () => this.choose(item));
    item.addEventListener('dblclick', () => this.onApply(what));
    item.what = what;
    return item;
  }

  choose(item) {
    for (const host of [this.own, this.library]) for (const other of host.children) other.setAttribute('aria-selected', String(other === item));
    item.focus();
  }

  key(event, host) {
    const items = [...host.children], i = items.indexOf(event.target);
    if (i < 0) return;
    const columns = getComputedStyle(host).gridTemplateColumns.split(' ').length;
    const to = { ArrowRight: i + 1, ArrowLeft: i - 1, ArrowDown: i + columns, ArrowUp: i - columns, Home: 0, End: items.length - 1 }[event.key];
    if (to !== undefined) {
      event.preventDefault();
      const next = items[Math.min(Math.max(to, 0), items.length - 1)];
      event.target.tabIndex = -1;
      next.tabIndex = 0;
      this.choose(next);
    } else if (event.key === 'Enter') {
      event.preventDefault();
      this.onApply(event.target.what);
    }
  }
}
