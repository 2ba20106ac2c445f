// SPDX-License-Identifier: MIT
// Rows of fields for values of the document.
import { element } from '../dom.mjs';
import { later } from './later.mjs';

export const valueAt = (object, pointer) => pointer.slice(1).split('/').reduce((inner, key) => inner?.[key], object);
/** A value of the document in a control, unless somebody is typing there. */
export const fill = (node, value) => { if (node !== document.activeElement) node.value = value ?? ''; };

export class FieldPanel {
  /** @param prefix of ids @param texts with `without`: what holds while a box is empty, by its id @param handlers by name */
  constructor(prefix, texts, handlers) { Object.assign(this, { prefix, texts, handlers }); }

  button(id, text, handler) {
    const node = element('button', { type: 'button', id }, text);
    node.addEventListener('click', () => this.handlers[handler]());
    return node;
  }

  /** A row whose label is seen. @param names of the controls, where there are several */
  row(text, controls, names = []) {
    names.forEach((name, i) => controls[i].setAttribute('aria-label', `${text}, ${name}`));
    return element('div', { class: controls.length > 2 ? 'field three' : 'field' }, element('label', { for: controls[0].id }, text), ...controls);
  }

  /** What holds while the box is empty stands in it. */
  numberBox(id, low, high) { return element('input', { id: `${this.prefix}-${id}`, type: 'number', step: 'any', min: low, max: high, autocomplete: 'off', placeholder: this.texts.without[id] ?? '' }); }

  /** Writes a number when it is one that may stand there. @param write(value or null) */
  writes(node, isNeeded, write) {
    return later(node, () => {
      if (node.value === '' && !isNeeded && !node.validity.badInput) write(null);
      else if (Number.isFinite(node.valueAsNumber) && node.checkValidity()) write(node.valueAsNumber);
    });
  }

  /** A list of which one is chosen, by its number. */
  listOf(id, text) {
    this.list = element('select', { id, size: '5' });
    this.list.addEventListener('change', () => this.handlers.choose(this.list.selectedIndex));
    this.list.addEventListener('keydown', (event) => { if (event.key === 'Delete' && this.list.selectedIndex >= 0) { event.preventDefault(); this.handlers.remove(); } });
    this.listRow = element('div', {}, element('label', { for: id }, text), this.list);
    return this.listRow;
  }

  /** @param names of the entries @param number of the chosen one, or null */
  showList(names, number) {
    const numbered = names.map((name, i) => `${i + 1}. ${name}`);
    if (JSON.stringify(numbered) !== this.names) this.list.replaceChildren(...numbered.map((name) => element('option', {}, name)));
    this.names = JSON.stringify(numbered);
    this.list.selectedIndex = number ?? -1;
    this.listRow.hidden = !names.length;
  }
}
