// SPDX-License-Identifier: MIT
// The list of parts with its search.
import { element } from './dom.mjs';

const $ = (id) => document.getElementById(id);
const MOST_LISTED = 500;

export class PartsList {
  /** @param nameOf of a use, @param choose called with a use */
  constructor(uses, nameOf, choose) {
    Object.assign(this, { uses, nameOf, choose });
    $('find').addEventListener('input', (e) => this.fill(e.target.value));
    $('parts').addEventListener('keydown', (e) => this.step(e));
    this.fill('');
  }

  fill(filter) {
    const wanted = filter.toLowerCase(), found = [];
    for (let i = 0; i < this.uses; ++i) if (this.nameOf(i).toLowerCase().includes(wanted)) found.push(i);
    $('parts').replaceChildren(...found.slice(0, MOST_LISTED).map((i) => {
      const item = element('li', { role: 'option', id: `use-${i}`, 'aria-selected': String(i === this.selected) }, this.nameOf(i));
      item.addEventListener('click', () => this.choose(i));
      return item;
    }));
    if (found.length > MOST_LISTED) $('parts').append(element('li', { role: 'presentation' }, `and ${found.length - MOST_LISTED} more: type to find them`));
  }

  step(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const items = [...$('parts').querySelectorAll('[role=option]')];
    const now = items.findIndex((item) => item.id === `use-${this.selected}`);
    const next = items[Math.min(Math.max(now + step, 0), items.length - 1)];
    if (next) this.choose(Number(next.id.slice(4)));
  }

  /** Marks a use; the list scrolls to it, the page does not. */
  select(use) {
    document.getElementById(`use-${this.selected}`)?.setAttribute('aria-selected', 'false');
    this.selected = use;
    const item = document.getElementById(`use-${use}`), list = $('parts');
    if (!item) return;
    item.setAttribute('aria-selected', 'true');
    list.setAttribute('aria-activedescendant', item.id);
    const top = item.offsetTop - list.offsetTop;
    if (top < list.scrollTop || top + item.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = top - list.clientHeight / 2;
  }
}
