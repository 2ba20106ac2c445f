// SPDX-License-Identifier: MIT
// The text of a recipe: line numbers, completion by the server, and the place of a mistake.
import { element } from '../dom.mjs';
import { post } from './api.mjs';
import { spliced } from './text_spans.mjs';
import { T } from './texts.mjs';

const SHOWN_AT_ONCE = 60, IN_NAME = /[\w.]/;

export class RecipeText {
  /** @param onInput called when it was typed in */
  constructor(host, onInput) {
    Object.assign(this, { onInput, problem: null, asked: 0, active: -1 });
    this.lines = element('div', { class: 'recipe-lines', 'aria-hidden': 'true' });
    this.area = element('textarea', { id: 'recipe-text', spellcheck: 'false', autocomplete: 'off', autocapitalize: 'off', 'aria-label': T.recipe.text, 'aria-describedby': 'recipe-problem', 'aria-autocomplete': 'list', 'aria-controls': 'recipe-completions' });
    this.list = element('div', { id: 'recipe-completions', role: 'listbox', 'aria-label': T.recipe.completions, hidden: '' });
    this.said = element('button', { id: 'recipe-problem', type: 'button', hidden: '' });
    host.append(element('div', { class: 'recipe-text' }, this.lines, this.area), this.list, this.said);
    this.area.addEventListener('input', () => { this.draw(); this.onInput(); this.asking = this.complete(); });
    this.area.addEventListener('keydown', (e) => this.key(e));
    this.area.addEventListener('blur', () => this.close());
    this.said.addEventListener('click', () => { this.area.focus(); this.area.setSelectionRange(this.problem.position, this.problem.position); });
    this.draw();
  }

  get value() { return this.area.value; }
  set value(text) {
    if (text === this.area.value) return;
    this.area.value = text;
    this.close();
    this.draw();
  }

  /** @param problem {reason, line, column, position} or null */
  setProblem(problem) {
    this.problem = problem;
    this.said.hidden = !problem;
    this.said.textContent = problem ? T.recipe.problem(problem) : '';
    this.area.setAttribute('aria-invalid', String(Boolean(problem)));
    this.draw();
  }

  /** Lines behind the text, which wrap as it does. */
  draw() {
    let begin = 0;
    const at = this.problem?.position ?? -1;
    this.lines.replaceChildren(...this.value.split('\n').map((line) => {
      const node = element('div', {}), from = at - begin, ends = at >= begin && at <= begin + line.length;
      if (ends) {
        let to = from;
        while (to < line.length && IN_NAME.test(line[to])) ++to;
        to = Math.max(to, from + 1);
        node.append(line.slice(0, from), element('mark', {}, line.slice(from, to) || ' '), line.slice(to));
      } else {
        node.append(line || '\u200b');
      }
      begin += line.length + 1;
      return node;
    }));
  }

  // ---- Completion.

  async complete(always = false) {
    const cursor = this.area.selectionStart, text = this.value, number = ++this.asked;
    if (!always && !(cursor > 0 && (IN_NAME.test(text[cursor - 1]) || '|=['.includes(text[cursor - 1])))) return this.close();
    const found = await post('recipe-completions', { text, cursor }).catch(() => null);
    if (number !== this.asked || text !== this.value) return undefined;  // A newer one is under way.
    if (!found?.all.length) return this.close();
    Object.assign(this, { found, shownFor: text });
    this.list.replaceChildren(...found.all.slice(0, SHOWN_AT_ONCE).map((c, i) => {
      const item = element('div', { role: 'option', id: `recipe-completion-${i}`, 'aria-selected': 'false', class: 'completion' }, element('b', {}, c.name), element('span', {}, c.note || T.recipe.kinds[c.kind]));
      item.addEventListener('pointerdown', (e) => { e.preventDefault(); this.accept(i); });
      return item;
    }));
    this.list.hidden = false;
    return this.activate(found.word[1] > found.word[0] ? 0 : -1);
  }

  close() {
    ++this.asked;
    this.list.hidden = true;
    this.area.removeAttribute('aria-activedescendant');
  }

  activate(index) {
    this.active = index;
    for (const [i, item] of [...this.list.children].entries()) item.setAttribute('aria-selected', String(i === index));
    if (index < 0) return this.area.removeAttribute('aria-activedescendant');
    this.list.children[index].scrollIntoView({ block: 'nearest' });
    return this.area.setAttribute('aria-activedescendant', `recipe-completion-${index}`);
  }

  /** The word at the cursor, which may have grown since the list was asked for. */
  get word() {
    const text = this.value;
    let begin = this.area.selectionStart, end = begin;
    while (begin > 0 && IN_NAME.test(text[begin - 1])) --begin;
    while (end < text.length && IN_NAME.test(text[end])) ++end;
    return [begin, end];
  }

  accept(index) {
    const { word } = this, { insert } = this.found.all[index];
    this.value = spliced(this.value, word, insert);
    this.area.focus();
    this.area.setSelectionRange(word[0] + insert.length, word[0] + insert.length);
    this.onInput();
    if (insert.endsWith('=')) this.asking = this.complete();
  }

  /** Enter or Tab: a list of a shorter word is not what was meant; the one under way is. */
  async acceptNewest(key) {
    while (this.shownFor !== this.value && !this.list.hidden) await this.asking;
    if (!this.list.hidden && this.active >= 0) { this.accept(this.active); return; }
    if (key !== 'Enter') return;
    this.area.setRangeText('\n', this.area.selectionStart, this.area.selectionEnd, 'end');
    this.area.dispatchEvent(new Event('input'));
  }

  key(event) {
    if (event.key === ' ' && (event.ctrlKey || event.metaKey)) { event.preventDefault(); this.asking = this.complete(true); return; }
    if (this.list.hidden) return;
    const count = this.list.children.length, step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) this.activate((this.active + step + count) % count);
    else if ((event.key === 'Enter' || event.key === 'Tab') && this.active >= 0) this.acceptNewest(event.key);
    else if (event.key === 'Escape') this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
