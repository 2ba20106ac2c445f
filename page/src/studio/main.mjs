// SPDX-License-Identifier: MIT
// Puts the studio's page together.
import { element } from '../dom.mjs';
import { ConnectionBroke, Socket, address, bytes, filesOf, get, parseSurface, post, upload } from './api.mjs';
import { Feel } from './feel.mjs';
import { DRAG_TYPE, MaterialList } from './materials.mjs';
import { Carriers } from './carriers.mjs';
import { Decals } from './decals.mjs';
import { colourAt } from './overlay.mjs';
import { number } from '../colour.mjs';
import { freeName } from './free_name.mjs';
import { GrainTurn } from './grain_turn.mjs';
import { PartPanel } from './part.mjs';
import { PhotoCard } from './photo_card.mjs';
import { RecipePanel } from './recipe_panel.mjs';
import { Review } from './review.mjs';
import { T } from './texts.mjs';
import { Tree } from './tree.mjs';
import { View } from './view.mjs';
import { WornPage } from './worn_page.mjs';
import { Headset } from '../xr/headset.mjs';

const $ = (id) => document.getElementById(id);
const MOST_AT_ONCE = 4;
const SOON_MS = 20, AGAIN_MS = 1000;

class Studio {
  constructor(data) { Object.assign(this, { data, state: null, scene: null, selected: new Set(), hidden: new Set(), shown: new Map(), made: new Set(), library: [] }); }  // `made`: names that were told ready, also before the state that has them.

  start() {
    this.words();
    this.view = new View($('canvas'), (hit, event) => this.pick(hit, event), (error) => this.failed(error));
    this.tree = new Tree($('tree'), (keys, add) => this.select(keys, add), (keys, event) => this.dropMaterial(event, keys));
    this.materials = new MaterialList($('own'), $('library'), (what) => this.apply(what, [...this.selected]));
    this.recipe = new RecipePanel($('panel-recipe'), $('tab-recipe'), this);
    this.panel = new PartPanel($('part'), {
      vary: (values) => this.vary(values), assign: (name) => this.apply({ material: name }, [...this.selected]),
      set: (material, values, key) => this.edit([{ kind: 'set', material, values }], T.did.set(material, key)),
      remove: (material) => this.edit([{ kind: 'remove', material }], T.did.remove(material)), turn: new GrainTurn(this.view, (values) => this.vary(values)),
      isRecipe: (text) => this.recipe.isRecipe(text), editRecipe: (material) => this.recipe.open(material),
    });
    this.listen();
    this.theme();
    this.connect();
    const shared = { view: this.view, socket: this.socket, say: (text, isProblem) => this.say(text, isProblem) };
    this.feel = new Feel($('panel-feel'), shared);
    this.review = new Review($('panel-notes'), { ...shared, labelOf: (key) => this.state.surfaces.find((s) => this.keyOf(s) === key) ?? {} });
    this.decals = new Decals($('panel-decals'), $('tab-decals'), this);
    this.carriers = new Carriers($('panel-decals'), this);
    this.card = new PhotoCard($('card'), $('own'), shared.say);
    this.worn = new WornPage(this);
    this.headset = new Headset(this.worn);
    this.worn.three.ready.then(() => this.headset.offer());
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
    this.socket.on('open', () => this.refreshSoon());  // What was told before.
    this.socket.on('ready', ({ surface }) => { this.made.add(surface); this.showSurfaces(); });
    this.socket.on('working', ({ left, label }) => {
      this.materials.pictures.hold(left > 0);
      this.view.levels.hold(left > 0);
      this.view.pace.hold(left > 0);
      this.say(left ? T.working(left, label) : T.ready);
    });
    this.socket.on('recipe-atlas', () => this.recipe.atlasCame());
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

  refreshSoon(ms = SOON_MS) {
    clearTimeout(this.refreshing);
    this.refreshing = setTimeout(() => this.refresh(), ms);
  }

  async refresh() {
    try {
      this.take(await get('state'));
    } catch (error) {
      this.failed(error);
    }
  }

  /** Tells why something was not fetched. Where the connection broke it is asked for again; what the server refuses it refuses again. */
  failed(error) {
    if (this.isLost) return;
    this.say(error.message, true);
    if (error instanceof ConnectionBroke) this.refreshSoon(AGAIN_MS);
  }

  take(state) {
    if (this.state && state.version < this.state.version) return;
    const sceneChanged = state.scene_number !== this.shownScene || (state.surfaces.length > 0) !== Boolean(this.scene);
    this.state = state;
    this.byKey = new Map(state.surfaces.map((s) => [this.keyOf(s), s]));
    document.body.dataset.version = state.version;
    $('undo').disabled = state.undo === null;
    $('redo').disabled = state.redo === null;
    $('undo').title = state.undo ? `${T.undo}: ${state.undo}` : T.undo;
    $('redo').title = state.redo ? `${T.redo}: ${state.redo}` : T.redo;
    $('file').textContent = state.file;
    $('saved').textContent = state.saved ? T.saved : T.unsaved;
    $('saved').dataset.saved = state.saved;
    $('bake').disabled = !state.surfaces.length;
    if ($('output').value === (this.offered ?? '')) $('output').value = this.offered = state.output;
    this.showCommand();
    $('welcome').hidden = state.surfaces.length > 0 || state.loading;
    if (state.problem) this.say(state.problem, true);
    if (state.load_problem && !state.loading) this.say(T.loadFailed(state.scene_file || state.file, state.load_problem), true);
    if (state.restored && !this.toldRestored) { this.toldRestored = true; this.say(T.restored); }
    this.materials.setDocument(state.document.materials);
    this.card.setDocument(state.document.materials);
    this.worn.documentChanged();
    this.recipe.setDocument();
    this.decals.setDocument();
    this.carriers.setDocument();
    if (sceneChanged && state.surfaces.length) return this.takeScene();
    return this.showSurfaces();
  }

  async takeScene() {
    this.shownScene = this.state.scene_number;
    try {
      this.scene = await get('scene');
    } catch (error) {
      this.shownScene = undefined;
      return this.failed(error);
    }
    this.shown.clear();
    this.selected = new Set();
    this.hidden = new Set();
    this.view.setScene(this.scene);
    this.decals.clear();
    this.carriers.clear();
    $('scene-file').textContent = this.scene.file;
    const stood = this.view.placeOfCamera();
    await this.showSurfaces();
    if (this.view.placeOfCamera().equals(stood)) this.view.frame();  // Who has moved meanwhile stays there.
  }

  keyOf(surface) { return `${surface.part}/${surface.slot}/${surface.uses[0]}`; }

  /** Fetches what the page does not show yet: as it will be where that is there, else as it was read. */
  async showSurfaces() {
    if (!this.scene || !this.state) return;
    const keys = new Set(this.byKey.keys());
    const same = JSON.stringify([...keys]);
    if (same !== this.treeKeys) {
      this.treeKeys = same;
      const byUse = new Map();
      for (const s of this.state.surfaces) for (const use of s.uses) byUse.set(use, [...byUse.get(use) ?? [], { key: this.keyOf(s), label: s.label }]);
      this.tree.fill(this.scene.uses, (use) => byUse.get(use) ?? []);
      this.view.keepOnly(keys);
      for (const key of [...this.shown.keys()]) if (!keys.has(key)) this.shown.delete(key);
    }
    for (const s of this.state.surfaces) s.ready ||= this.made.has(s.name);
    const wanted = this.state.surfaces.filter((s) => this.isToFetch(s)).map((s) => this.keyOf(s));
    const next = async () => {
      while (wanted.length) {  // Meanwhile there may be a newer state, which wants something else.
        const surface = this.byKey.get(wanted.shift());
        if (surface && this.isToFetch(surface)) await this.fetchSurface(surface);
      }
    };
    await Promise.all([...Array.from({ length: MOST_AT_ONCE }, next), this.decals.showReady(), this.carriers.showReady()]);
    this.showPart();
    this.legend();
    document.body.dataset.shown = [...this.shown.values()].filter((s) => s.name).length;
  }

  /** One that was made and is neither shown nor under way, or of which nothing is. */
  isToFetch(surface) {
    const shown = this.shown.get(this.keyOf(surface));
    return surface.ready ? shown?.loading !== surface.name : !shown;
  }

  async fetchSurface(surface) {
    const key = this.keyOf(surface), name = surface.ready ? surface.name : '';
    const place = name ? { id: name } : { part: surface.part, slot: surface.slot };
    const entry = { ...this.shown.get(key), loading: name };
    this.shown.set(key, entry);
    try {
      const data = parseSurface(await bytes('surface', place));
      if (this.shown.get(key) !== entry) return;  // A newer one is under way.
      await this.view.setSurface(key, data, surface.uses, filesOf(place));
      if (this.shown.get(key) === entry) Object.assign(entry, { data, name });
      this.recipe.dressAgain(key);
    } catch (error) {
      if (this.shown.get(key) === entry) this.shown.delete(key);
      this.failed(error);
    }
  }

  // ---- Selection.

  surfacesOf(keys) { return this.state.surfaces.filter((s) => keys.has(this.keyOf(s))); }

  pick(hit, event) {
    if (this.decals.pick(hit)) return undefined;
    this.review.pickAt(hit);
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

  /** @returns whether it was done */
  async edit(edits, title) {
    try {
      this.take(await post('edit', { edits, title }));
      return true;
    } catch (error) {
      this.say(error.message, true);
      return false;
    }
  }

  slots(keys) { return this.surfacesOf(new Set(keys)).map((s) => [s.part, s.slot]); }

  /** The change that gives surfaces a material of the document, or of the library, which comes into the document. */
  editOf({ material, library: id }, keys) {
    const { materials = {} } = this.state.document, onto = (name) => ({ kind: 'assign', surfaces: this.slots(keys), material: name ?? '' });
    const own = id && Object.entries(materials).find(([, m]) => m.material === `library:${id}` && Object.keys(m).length === 1), name = id ? own?.[0] ?? id : material;
    const add = !id || own || name in materials ? [] : [{ kind: 'add', material: name, values: { '/material': `library:${id}` } }];
    return { edits: [...add, onto(name)], title: T.did.assign(name, this.whatOf(keys)) };
  }

  apply(what, keys) {
    if (!keys.length) return this.say(T.selectFirst);
    const { edits, title } = this.editOf(what, keys);
    return this.edit(edits, title);
  }

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

  // ---- Files.

  /** A photograph becomes a material of its name, for what is selected if anything is. */
  async addPhoto(file) {
    const width = Number(prompt(T.widthAsk(file.name), '40'));
    if (!(width > 0)) return;
    try {
      const bitmap = await createImageBitmap(file);
      const { file: texture } = await upload('photograph', file, (share) => this.progress(T.sending(file.name, Math.round(100 * share)), share)).promise;
      const name = freeName(texture.replace(/\.\w+$/, ''), this.state.document.materials), height = Math.round(1e3 * width * bitmap.height / bitmap.width) / 1e3, surfaces = this.slots([...this.selected]);
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

  showOverlay(id) {
    if (!(id in T.overlays)) return;
    $('overlay').value = id;
    this.view.setOverlay(id);
    this.legend();
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
    const withChosen = (work) => {
      const chosen = document.querySelector('.material[aria-selected=true]');
      if (chosen) work(chosen.what);
    };
    on('apply', 'click', () => withChosen((what) => this.apply(what, [...this.selected])));
    on('add-recipe', 'click', () => this.openTab($('tab-recipe')));
    on('edit-recipe', 'click', () => withChosen((what) => this.recipe.openChosen(what)));
    on('add-photo', 'click', () => $('photo-file').click());
    on('photo-file', 'change', (e) => { if (e.target.files[0]) this.addPhoto(e.target.files[0]); e.target.value = ''; });
    on('hide', 'click', () => this.setHidden(new Set([...this.hidden, ...this.selected])));
    on('isolate', 'click', () => this.setHidden(new Set(this.state.surfaces.map((s) => this.keyOf(s)).filter((key) => !this.selected.has(key)))));
    on('show-all', 'click', () => this.setHidden(new Set()));
    on('frame', 'click', () => this.view.frame(this.selected.size ? this.selected : null));
    on('camera', 'change', (e) => e.target.value === 'seat' ? this.view.seat() : this.view.setMode(e.target.value));
    on('light', 'change', (e) => e.target.value === 'own' ? $('own-light').click() : this.view.setLight(e.target.value));
    on('own-light', 'change', (e) => e.target.files[0] && this.view.setOwnLight(e.target.files[0]).catch((error) => this.say(error.message, true)));
    on('overlay', 'change', (e) => this.showOverlay(e.target.value));
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
    addEventListener('beforeunload', (e) => { if (this.state && (!this.state.saved || this.recipe.isChanged) && !this.isLost) e.preventDefault(); });
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
    if (file && !file.type.startsWith('image/')) return this.openFile(file);
    if (file && this.decals.takesFiles) return this.decals.begin(file, event.target === $('canvas') ? this.view.hitAt(event) : null);
    return file && this.addPhoto(file);
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
