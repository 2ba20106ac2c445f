// SPDX-License-Identifier: MIT
// Follows `papilla weather --live`: pixels of materials that change, and mistakes in its recipes.
const $ = (id) => document.getElementById(id);

/** What /looks answers: a JSON text behind its length, and the pixels that it tells the places of. Pictures that stay have no key. */
function parse(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const pixels = (place) => place && new Uint8Array(buffer, 4 + length + place.at, place.bytes);
  for (const look of json.materials) for (const map of ['color', 'normal', 'shine']) if (map in look) look[map] = pixels(look[map]);
  return json;
}

export class Looks {
  /** @param three may be missing where the browser can't draw in 3D */
  constructor({ page, version }, three) {
    Object.assign(this, { page, three, shown: version, wanted: version, count: 0 });
    this.say('Shows what is saved, as soon as it is.');
    const events = new EventSource(`live${location.search}`);  // with the token of the page's address
    events.addEventListener('looks', (e) => this.hear(JSON.parse(e.data)));
    events.addEventListener('error', () => this.say('papilla weather has ended. When it starts again it gives a new address.', 'lost'));
  }

  say(text, state = 'following') {
    $('looks').hidden = false;
    $('looks').textContent = text;
    $('looks').dataset.state = state;
  }

  hear({ page, version, problem }) {
    if (page !== this.page) return location.reload();
    $('looks-problem').hidden = !problem;
    $('looks-problem').textContent = problem;
    this.wanted = version;
    return this.take();
  }

  /** Fetches and draws what is new; what comes meanwhile is taken next, all at once. */
  async take() {
    if (this.busy || this.wanted <= this.shown || !this.three) return;
    this.busy = true;
    try {
      const answer = await fetch(`looks${location.search}`, { method: 'POST', body: JSON.stringify({ since: this.shown }) });
      if (!answer.ok) throw new Error(`status ${answer.status}`);
      const { page, version, materials } = parse(await answer.arrayBuffer());
      if (page !== this.page) return location.reload();
      await this.three.setLooks(materials);
      this.shown = version;
      Object.assign($('looks').dataset, { version, count: ++this.count });
      if (this.wanted <= version) this.say(`Change ${this.count} is shown.`);  // laying out the page anew each time costs a picture
    } catch (error) {
      return this.say(`A change could not be shown: ${error.message}`, 'lost');
    } finally {
      this.busy = false;
    }
    return this.take();
  }
}
