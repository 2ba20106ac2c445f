// SPDX-License-Identifier: MIT
// Chromium with one page open that must not complain and must not ask the network for anything.
import { existsSync, mkdirSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const POLLING_MS = 50;
const STEP_MS = 300_000;  // Many times what any step takes: one that does not end is told by its name, and not by the limit of ctest.
const PLACES = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];

/** Ends the test as skipped when there is no browser. */
export async function launch(more = []) {
  const executablePath = PLACES.find((place) => place && existsSync(place));
  const playwright = await import('playwright-core').catch(() => null);
  if (!executablePath || !playwright) {
    console.log(executablePath ? 'playwright-core is not installed (npm ci)' : 'there is no Chromium');
    process.exit(77);
  }
  return playwright.chromium.launch({ executablePath, timeout: 0, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...more] });
}

/** Opens the file, which may ask the network for nothing. */
export const open = (browser, file, options = {}) => openUrl(browser, pathToFileURL(file).href, options);

/** Opens an address, `init` run before all scripts of the page; `complaints` collects errors, warnings and requests for anything but the page and its server. */
export async function openUrl(browser, url, { init, ...options } = {}) {
  const own = url.startsWith('http') ? new URL(url).origin : 'file:';
  const page = await browser.newPage({ viewport: { width: 1400, height: 950 }, ...options });
  const complaints = [];
  const wait = page.waitForFunction.bind(page);  // By the clock: where a processor draws, the next picture may be long in coming.
  page.waitForFunction = (work, argument, more) => wait(work, argument, { polling: POLLING_MS, ...more });
  page.setDefaultTimeout(STEP_MS);
  page.on('console', (message) => { if (message.type() === 'error') complaints.push(message.text()); });
  page.on('pageerror', (error) => complaints.push(error.stack));
  page.on('dialog', (dialog) => { complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on('request', (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(own)) complaints.push(`network: ${request.url()}`); });
  if (init) await page.addInitScript({ content: init });
  await page.goto(url);
  await page.waitForSelector('body[data-ready=yes]');
  return { page, complaints };
}

export function folder(path) {
  mkdirSync(path, { recursive: true });
  return path;
}

export const text = (page, selector) => page.locator(selector).evaluate((node) => node.tagName === 'OUTPUT' ? node.value : node.textContent);

/** The colour in the middle of the scene, sRGB. */
export async function middleOf(page) {
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));  // is drawn with them
  const picture = (await page.locator('#canvas3d').screenshot()).toString('base64');
  return page.evaluate(async (base64) => {
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], { type: 'image/png' }));
    const context = Object.assign(document.createElement('canvas'), { width: bitmap.width, height: bitmap.height }).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    return [...context.getImageData(bitmap.width >> 1, bitmap.height >> 1, 1, 1).data.slice(0, 3)];
  }, picture);
}

/** The colour behind the scene, sRGB. */
export const backgroundOf = (page) => page.evaluate(() => {
  const colour = getComputedStyle(document.documentElement).getPropertyValue('--scene').trim();
  return [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
});
