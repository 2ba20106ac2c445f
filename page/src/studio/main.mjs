// SPDX-License-Identifier: MIT
// Puts the studio's page together.
import { element } from '../dom.mjs';
import { Socket, address, blob, bytes, get, parseSurface, post, upload } from './api.mjs';
import { DRAG_TYPE, MaterialList } from './materials.mjs';
import { colourAt } from './overlay.mjs';
import { number } from '../colour.mjs';
import { PartPanel } from './part.mjs';
import { T } from './texts.mjs';
import { Tree } from './tree.mjs';
import { View } from './view.mjs';

const $ = (id) => document.getElementById(id);
const MOST_AT_ONCE = 4;

class Studio {
  constructor(data) { Object.assign(this, { data, state: null, scene: null, selected: new Set(), hidden: new Set(), shown: new Map(), library: [] }); }

  start() {
    this.words();
    this.view = new View($('canvas'), (hit, event) => this.pick(hit, event));
    this.tree = new Tree($('tree'), (keys, add) => this.select(keys, add), (keys, event) => this.dropMaterial(event, keys));
    this.materials = new MaterialList($('own'), $('library'), (what) => this.apply(what, [...this.selected]));
    this.panel = new PartPanel($('part'), {
      vary: (values) => this.vary(values), assign: (name) => this.assign(name, [...this.selected]),
      set: (material, values, key) => this.edit([{ kind: 'set', material, values }], T.did.set(material, key)),
      remove: (material) => this.edit([{ kind: 'remove', material }], T.did.remove(material)),
    });
    this.listen();
    this.theme();
    this.connect();
    get('library').then((list) => { this.library = list; this.materials.setLibrary(list); this.showPart(); }).catch((error) => this.say(error.message, true));
    return this.refresh();
  }

  /** Texts of the page that stay. */
  words() {
    for (const node of document.querySelectorAll('[data-t]')) node.textContent = node.dataset.t.split('.').reduce((texts, key) => texts[key], T);
    for (const node of document.querySelectorAll('[data-label]')) {
      const text = node.dataset.label.split('.').reduce((texts, key) => texts[key], T);
      node.setAttribute('aria-label', text);
      if (node.tagName === 'INPUT' && node.type === 'search') node.placeholder = text;
    }
    const fill = (id, texts) => $(id).append(...Object.entries(texts).map(([value, text]) => element('option', { value }, text)));
    fill('camera', T.cameras);
    fill('light', T.lights);
    fill('overlay', T.overlays);
    fill('map', T.maps);
    fill('section', T.sections);
    document.title = T.title;
  }

  theme() {
    const paint = () => this.view.setBackground(getComputedStyle(document.body).getPropertyValue('--stage').trim());
    $('theme').addEventListener('click', () => {
      const root = document.documentElement, dark = root.dataset.theme ? root.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
      root.dataset.theme = dark ? 'light' : 'dark';
      paint();
    });
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', paint);
    paint();
  }

  connect() {
    this.socket = new Socket(this.data.socket);
    this.socket.on('state', () => this.refreshSoon());
    this.socket.on('ready', ({ surface }) => { this.showSurfaces(surface); });
    this.socket.on('working', ({ left, label }) => this.say(left ? T.working(left, label) : T.ready));
    this.socket.on('failed', ({ label, problem }) => this.say(T.failed(label, problem), true));
    this.socket.on('problem', ({ text }) => this.say(text, true));
    this.socket.on('loading', (event) => this.progress(T.loading(event.file, event.stage, Math.round(100 * event.fraction)), event.fraction));
    this.socket.on('loaded', ({ file, problem }) => {
      this.progress(null);
      if (problem) this.say(T.loadFailed(file, problem), true);
      this.refresh();
    });
    this.socket.on('bake', (event) => this.showBake(event));
    this.socket.on('lost', () => { this.isLost = true; this.say(T.lost, true); document.body.dataset.state = 'lost'; });
  }

  // ---- State.

  refreshSoon() {
    clearTimeout(this.refreshing);
    this.refreshing = setTimeout(() => this.refresh(), 20);
  }

  async refresh() {
    try {
      this.take(await get('state'));
    } catch (error) {
      if (!this.isLost) this.say(error.message, true);
    }
  }

  take(state) {
    if (this.state && state.version < this.state.version) return;
    const sceneChanged = state.scene_file !== this.shownFile || (state.surfaces.length > 0) !== Boolean(this.scene);
    this.state = state;
    document.body.dataset.version = state.version;
    $('undo').disabled = state.undo === null;
    $('redo').disabled = state.redo === null;
    $('undo').title = state.undo ? `${T.undo}: ${state.undo}` : T.undo;
    $('redo').title = state.redo ? `${T.redo}: ${state.redo}` : T.redo;
    $('file').textContent = state.file;
    $('saved').textContent = state.saved ? T.saved : T.unsaved;
    $('saved').dataset.saved = state.saved;
    $('bake').disabled = !state.surfaces.length;
    if (!$('output').value) $('output').value = state.output;
    this.showCommand();
    $('welcome').hidden = state.surfaces.length > 0 || state.loading;
    if (state.problem) this.say(state.problem, true);
    if (state.load_problem && !state.loading) this.say(T.loadFailed(state.scene_file, state.load_problem), true);
    if (state.restored && !this.toldRestored) { this.toldRestored = true; this.say(T.restored); }
    this.materials.setDocument(state.document.materials);
    if (sceneChanged && state.surfaces.length) return this.takeScene();
    return this.showSurfaces();
  }

  async takeScene() {
    this.shownFile = this.state.scene_file;
    this.scene = await get('scene');
    this.shown.clear();
    this.selected = new Set();
    this.hidden = new Set();
    this.view.setScene(this.scene);
    $('scene-file').textContent = this.scene.file;
    await this.showSurfaces();
    this.view.frame();
  }

  keyOf(surface) { return `${surface.part}/${surface.slot}/${surface.uses[0]}`; }

  /** Fetches what the page does not show yet: as it will be where that is there, else as it was read. */
  async showSurfaces(only) {
    if (!this.scene || !this.state) return;
    const keys = new Set(this.state.surfaces.map((s) => this.keyOf(s)));
    const same = JSON.stringify([...keys]);
    if (same !== this.treeKeys) {
      this.treeKeys = same;
      const byUse = new Map();
      for (const s of this.state.surfaces) for (const use of s.uses) byUse.set(use, [...byUse.get(use) ?? [], { key: this.keyOf(s), label: s.label }]);
      this.tree.fill(this.scene.uses, (use) => byUse.get(use) ?? []);
      this.view.keepOnly(keys);
    }
    if (only) for (const s of this.state.surfaces) if (s.name === only) s.ready = true;
    const wanted = this.state.surfaces.filter((s) => {
      const name = s.ready ? s.name : null, shown = this.shown.get(this.keyOf(s));
      return shown?.loading !== (name ?? shown?.loading ?? '') && (name !== null || !shown);
    });
    const next = async () => {
      for (let surface = wanted.shift(); surface; surface = wanted.shift()) await this.fetchSurface(surface);
    };
    await Promise.all(Array.from({ length: MOST_AT_ONCE }, next));
    this.showPart();
    this.legend();
    document.body.dataset.shown = [...this.shown.values()].filter((s) => s.name).length;
  }

  async fetchSurface(surface) {
    const key = this.keyOf(surface), name = surface.ready ? surface.name : '';
    const place = name ? { id: name } : { part: surface.part, slot: surface.slot };
    const entry = { ...this.shown.get(key), loading: name };
    this.shown.set(key, entry);
    try {
      const data = parseSurface(await bytes('surface', place));
      if (this.shown.get(key) !== entry) return;  // A newer one is under way.
      await this.view.setSurface(key, data, surface.uses, (image) => blob('picture', { ...place, image }));
      if (this.shown.get(key) === entry) Object.assign(entry, { data, name });
    } catch (error) {
      if (this.shown.get(key) === entry) this.shown.delete(key);
      if (!this.isLost) this.say(error.message, true);
    }
  }

  // ---- Selection.

  surfacesOf(keys) { return this.state.surfaces.filter((s) => keys.has(this.keyOf(s))); }

  pick(hit, event) {
    if (!hit) return event.ctrlKey || event.shiftKey ? undefined : this.select([], false);
    this.select([hit.key], event.ctrlKey || event.metaKey || event.shiftKey);
    return this.tree.reveal(hit.key);
  }

  select(keys, add) {
    if (!add) this.selected = new Set(keys);
    else if (keys.every((key) => this.selected.has(key))) for (const key of keys) this.selected.delete(key);
    else for (const key of keys) this.selected.add(key);
    this.view.setSelected(this.selected);
    this.tree.mark(this.selected, this.hidden);
    $('selected').textContent = T.selected(this.selected.size);
    this.showPart();
  }

  setHidden(keys) {
    this.hidden = keys;
    this.view.setHidden(keys);
    this.tree.mark(this.selected, keys);
  }

  showPart() {
    if (!this.state) return;
    const surfaces = this.surfacesOf(this.selected);
    this.panel.show(surfaces, surfaces.map((s) => this.shown.get(this.keyOf(s))?.data).filter(Boolean), this.state.document, this.library);
  }

  whatOf(keys) {
    const surfaces = this.surfacesOf(new Set(keys));
    return surfaces.length ? T.more(surfaces[0].label, surfaces.length) : T.none;
  }

  // ---- Changes.

  async edit(edits, title) {
    try {
      this.take(await post('edit', { edits, title }));
    } catch (error) {
      this.say(error.message, true);
    }
  }

  slots(keys) { return this.surfacesOf(new Set(keys)).map((s) => [s.part, s.slot]); }

  /** A material of the document, or of the library, which comes into the document. */
  apply(what, keys) {
    if (!keys.length) return this.say(T.selectFirst);
    if (!what.library) return this.assign(what.material, keys);
    const id = what.library, own = Object.entries(this.state.document.materials ?? {}).find(([, m]) => m.material === `library:${id}` && Object.keys(m).length === 1);
    const name = own?.[0] ?? id, taken = !own && name in (this.state.document.materials ?? {});
    if (taken) return this.assign(name, keys);
    const add = own ? [] : [{ kind: 'add', material: name, values: { '/material': `library:${id}` } }];
    return this.edit([...add, { kind: 'assign', surfaces: this.slots(keys), material: name }], T.did.assign(name, this.whatOf(keys)));
  }

  assign(name, keys) { return this.edit([{ kind: 'assign', surfaces: this.slots(keys), material: name ?? '' }], T.did.assign(name, this.whatOf(keys))); }

  vary(values) {
    const surfaces = this.surfacesOf(this.selected);
    if (!surfaces.length) return;
    this.edit([{ kind: 'vary', surfaces: surfaces.map((s) => [s.part, s.slot]), material: surfaces[0].material, values }], T.did.vary(this.whatOf([...this.selected])));
  }

  dropMaterial(event, keys) {
    if (![...event.dataTransfer.types].includes(DRAG_TYPE)) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.type !== 'drop') return;
    const on = keys.some((key) => this.selected.has(key)) ? [...this.selected] : keys;
    this.apply(JSON.parse(event.dataTransfer.getData(DRAG_TYPE)), on);
  }

  async step(path) {
    try {
      this.take(await post(path));
    } catch (error) {
      this.say(error.message, true);
    }
  }

  addRecipe() {
    const recipe = prompt(T.recipeAsk);
    const name = recipe && prompt(T.nameAsk, recipe.split('|')[0]);
    if (name) this.edit([{ kind: 'add', material: name, values: { '/texture': recipe, '/size_mm': [40, 40] } }], T.did.add(name));
  }

  // ---- Files.

  /** A photograph becomes a material of its name, for what is selected if anything is. */
  async addPhoto(file) {
    const width = Number(prompt(T.widthAsk(file.name), '40'));
    if (!(width > 0)) return;
    try {
      const bitmap = await createImageBitmap(file);
      const { file: texture } = await upload('photograph', file, (share) => this.progress(T.sending(file.name, Math.round(100 * share)), share)).promise;
      const name = texture.replace(/\.\w+$/, ''), height = Math.round(1e3 * width * bitmap.height / bitmap.width) / 1e3, surfaces = this.slots([...this.selected]);
      const add = { kind: 'add', material: name, values: { '/texture': texture, '/size_mm': [width, height] } };
      await this.edit(surfaces.length ? [add, { kind: 'assign', surfaces, material: name }] : [add], T.did.add(name));
    } catch (error) {
      this.say(error.message, true);
    }
    this.progress(null);
  }

  openFile(file) {
    this.cancel?.();
    const sent = upload('open', file, (share) => this.progress(T.sending(file.name, Math.round(100 * share)), share));
    this.cancel = sent.cancel;
    sent.promise.catch((error) => { this.progress(null); this.say(T.loadFailed(file.name, error.message), true); });
  }

  progress(text, fraction = 0) {
    $('progress').hidden = text === null;
    if (text === null) return;
    $('progress-text').textContent = text;
    $('progress-bar').value = fraction;
  }

  // ---- Bake.

  showCommand() {
    const output = $('output').value || this.state.output, report = $('report').value;
    const quote = (word) => /^[\w./:=@%+,-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
    const { command } = this.state, given = ` -o ${quote(this.state.output)}`;
    $('command').textContent = command.replace(given, ` -o ${quote(output)}${report ? ` --report ${quote(report)}` : ''}`);
  }

  async bake() {
    try {
      $('bake-state').textContent = T.bakeState.running;
      document.body.dataset.bake = 'running';
      const { command, state } = await post('bake', { output: $('output').value, report: $('report').value });
      this.take(state);
      $('command').textContent = command;
    } catch (error) {
      document.body.dataset.bake = 'failed';
      $('bake-state').textContent = error.message;
    }
  }

  showBake({ state, stage, fraction, messages, output, bytes: size, report }) {
    document.body.dataset.bake = state;
    $('cancel-bake').hidden = state !== 'running';
    $('bake-bar').hidden = state !== 'running';
    $('bake-bar').value = fraction;
    $('bake-state').textContent = state === 'running' ? `${T.bakeState.running}${stage ? `: ${stage}, ${Math.round(100 * fraction)} %` : ''}`
      : state === 'done' ? `${T.bakeState.done}: ${output}, ${number(size / 1e6)} MB` : `${T.bakeState[state]}${messages ? `: ${messages}` : ''}`;
    $('open-report').hidden = state !== 'done' || !report;
    $('open-report').href = address('report');
  }

  // ---- Around.

  say(text, isProblem = false) {
    $('status').textContent = text;
    $('status').dataset.problem = isProblem;
    if (isProblem) $('status').title = text; else $('status').removeAttribute('title');
  }

  legend() {
    const { overlay, map } = this.view, scaled = overlay === 'stretch' || overlay === 'angle';
    $('legend').hidden = overlay === 'textured';
    if (overlay === 'textured') return;
    const range = this.view.setOverlay(overlay, map), canvas = $('scale'), context = canvas.getContext('2d');
    canvas.hidden = $('map').hidden = !scaled;
    $('legend-text').textContent = scaled ? `${T.legend[overlay]}: ${number(range[0])} … ${number(range[1])}; ${T.legend.none}` : T.legend.checker;
    for (let x = 0; scaled && x < canvas.width; ++x) {
      context.fillStyle = `rgb(${colourAt(map, x / (canvas.width - 1)).map(Math.round).join(' ')})`;
      context.fillRect(x, 0, 1, canvas.height);
    }
  }

  listen() {
    const on = (id, name, work) => $(id).addEventListener(name, work);
    on('undo', 'click', () => this.step('undo'));
    on('redo', 'click', () => this.step('redo'));
    on('save', 'click', () => this.step('save'));
    on('bake', 'click', () => this.bake());
    on('cancel-bake', 'click', () => post('bake-cancel').catch(() => {}));
    for (const id of ['output', 'report']) on(id, 'input', () => this.showCommand());
    on('copy', 'click', async () => {
      await navigator.clipboard.writeText($('command').textContent).catch(() => getSelection().selectAllChildren($('command')));
      this.say(T.copied);
    });
    on('find-part', 'input', (e) => this.tree.find(e.target.value));
    on('find-material', 'input', (e) => this.materials.find(e.target.value));
    on('apply', 'click', () => {
      const chosen = document.querySelector('.material[aria-selected=true]');
      if (chosen) this.apply(chosen.what, [...this.selected]);
    });
    on('add-recipe', 'click', () => this.addRecipe());
    on('add-photo', 'click', () => $('photo-file').click());
    on('photo-file', 'change', (e) => { if (e.target.files[0]) this.addPhoto(e.target.files[0]); e.target.value = ''; });
    on('hide', 'click', () => this.setHidden(new Set([...this.hidden, ...this.selected])));
    on('isolate', 'click', () => this.setHidden(new Set(this.state.surfaces.map((s) => this.keyOf(s)).filter((key) => !this.selected.has(key)))));
    on('show-all', 'click', () => this.setHidden(new Set()));
    on('frame', 'click', () => this.view.frame(this.selected.size ? this.selected : null));
    on('camera', 'change', (e) => e.target.value === 'seat' ? this.view.seat() : this.view.setMode(e.target.value));
    on('light', 'change', (e) => e.target.value === 'own' ? $('own-light').click() : this.view.setLight(e.target.value));
    on('own-light', 'change', (e) => e.target.files[0] && this.view.setOwnLight(e.target.files[0]).catch((error) => this.say(error.message, true)));
    on('overlay', 'change', (e) => { this.view.setOverlay(e.target.value); this.legend(); });
    on('map', 'change', (e) => { this.view.setOverlay(this.view.overlay, e.target.value); this.legend(); });
    on('seams', 'change', (e) => this.view.setSeams(e.target.checked));
    const cut = () => { $('section-place').hidden = $('section').value === 'off'; this.view.setSection($('section').value, $('section-place').valueAsNumber); };
    on('section', 'change', cut);
    on('section-place', 'input', cut);
    on('open', 'click', () => $('open-file').click());
    on('choose', 'click', () => $('open-file').click());
    on('open-file', 'change', (e) => { if (e.target.files[0]) this.openFile(e.target.files[0]); e.target.value = ''; });
    on('cancel-open', 'click', () => { this.cancel?.(); post('open-cancel').catch(() => {}); this.progress(null); });
    for (const name of ['dragover', 'drop']) document.addEventListener(name, (e) => this.dropFile(e));
    for (const name of ['dragover', 'drop']) on('canvas', name, (e) => {
      const hit = e.type === 'drop' ? this.view.hitAt(e) : null;
      this.dropMaterial(e, hit ? [hit.key] : []);
    });
    document.addEventListener('keydown', (e) => this.key(e));
    addEventListener('beforeunload', (e) => { if (this.state && !this.state.saved && !this.isLost) e.preventDefault(); });
    for (const tab of document.querySelectorAll('[role=tab]')) {
      tab.addEventListener('click', () => this.openTab(tab));
      tab.addEventListener('keydown', (e) => {
        const tabs = [...document.querySelectorAll('[role=tab]')], step = { ArrowRight: 1, ArrowLeft: -1 }[e.key];
        if (step) { e.preventDefault(); this.openTab(tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length]); }
      });
    }
  }

  openTab(tab) {
    for (const other of document.querySelectorAll('[role=tab]')) {
      other.setAttribute('aria-selected', String(other === tab));
      other.tabIndex = other === tab ? 0 : -1;
      $(other.getAttribute('aria-controls')).hidden = other !== tab;
    }
    tab.focus();
  }

  dropFile(event) {
    if (![...event.dataTransfer.types].includes('Files')) return;
    event.preventDefault();
    if (event.type !== 'drop') return;
    const [file] = event.dataTransfer.files;
    if (file) return file.type.startsWith('image/') ? this.addPhoto(file) : this.openFile(file);
  }

  key(event) {
    const typing = /INPUT|SELECT|TEXTAREA/.test(event.target.tagName), control = event.ctrlKey || event.metaKey, name = event.key.toLowerCase();
    const run = (work) => { event.preventDefault(); work(); };
    if (control && name === 's') return run(() => this.step('save'));
    if (typing) return undefined;
    if (control && name === 'z') return run(() => this.step(event.shiftKey ? 'redo' : 'undo'));
    if (control && name === 'y') return run(() => this.step('redo'));
    if (control || event.altKey || this.view.mode === 'walk') return undefined;
    return { h: () => $('hide').click(), i: () => $('isolate').click(), u: () => $('show-all').click(), f: () => $('frame').click(), escape: () => this.select([], false) }[name]?.();
  }
}

const studio = new Studio(JSON.parse($('data').textContent));
globalThis.studio = studio;  // For tests and for those who like to look.
studio.start().then(() => { document.body.dataset.ready = 'yes'; });
