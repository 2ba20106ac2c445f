// SPDX-License-Identifier: MIT
// How long a material takes from its drop on a surface until it is drawn: node drops.mjs PAPILLA SCENE SURFACE OUT.json
// Every material is new to the server, whose cache is empty at the start.
import { copyFileSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { launch, openUrl } from '../page/browser.mjs';
import { allShown } from './page.mjs';
import { end, start } from './studio.mjs';

const MATERIALS = 6;
const [papilla, scene, surface, out] = process.argv.slice(2);
const browser = await launch(), folder = mkdtempSync(join(tmpdir(), 'papilla-drops-'));
copyFileSync(scene, join(folder, basename(scene)));
const studio = await start(papilla, [basename(scene), '-m', 'm.json', '--cache', join(folder, 'cache')], { cwd: folder });
try {
  const { page } = await openUrl(browser, studio.url, { viewport: { width: 1280, height: 860 } });
  await allShown(page);
  // At rest: the library's pictures, made anew here, and the levels of detail are there.
  await page.waitForFunction(() => {
    const { library, materials: { pictures }, view } = globalThis.studio;
    return library.length > 0 && !pictures.loading && pictures.waiting.length === 0 && view.levels.missing === 0;
  });
  const drops = await page.evaluate(async ([label, most]) => {
    const { studio: s } = globalThis, found = [];
    const wanted = s.library.filter(({ name }) => name.startsWith('leather/')).slice(0, most);
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    // The last full picture is drawn, too: that begins some frames after nothing is coarse any more.
    const rest = async () => {
      const { view } = s;
      for (let still = 0; still < 20; ++still) {
        await frame();
        if (view.pace.isCoarse || view.pace.fence || view.levels.missing > 0) still = -1;
      }
    };
    for (const { name } of wanted) {
      await rest();
      const of = () => s.state.surfaces.find((x) => x.label === label), key = s.keyOf(of()), begin = performance.now();
      await s.apply({ library: name }, [key]);
      const answered = performance.now();
      while (!of().ready) await frame();
      const ready = performance.now();
      while (s.shown.get(key)?.name !== of().name) await frame();
      const taken = performance.now(), frames = Number(s.view.canvas.dataset.frames);
      s.view.changing();
      while (Number(s.view.canvas.dataset.frames) === frames) await frame();
      await frame();
      found.push({ name, drawn_ms: performance.now() - begin, answered_ms: answered - begin, ready_ms: ready - begin, taken_ms: taken - begin, server_ms: 1000 * s.shown.get(key).data.seconds });
    }
    return found;
  }, [surface, MATERIALS]);
  writeFileSync(out, JSON.stringify(drops));
} finally {
  await browser.close();
  await end(studio.child, 'SIGKILL');
  rmSync(folder, { recursive: true, force: true });
}
