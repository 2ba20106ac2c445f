// SPDX-License-Identifier: MIT
// Chromium with one page open that must not complain and must not ask the network for anything.
import { existsSync, mkdirSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

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

/** Opens an address; `complaints` collects errors, warnings and requests for anything but the page and its server. */
export async function openUrl(browser, url, options = {}) {
  const own = url.startsWith('http') ? new URL(url).origin : 'file:';
  const page = await browser.newPage({ viewport: { width: 1400, height: 950 }, ...options });
  const complaints = [];
  page.setDefaultTimeout(0);  // ctest limits the whole test; how long a step takes is the machine's affair
  page.on('console', (message) => { if (message.type() === 'error') complaints.push(message.text()); });
  page.on('pageerror', (error) => complaints.push(error.stack));
  page.on('dialog', (dialog) => { complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on('request', (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(own)) complaints.push(`network: ${request.url()}`); });
  await page.goto(url);
  await page.waitForSelector('body[data-ready=yes]');
  return { page, complaints };
}

export function folder(path) {
  mkdirSync(path, { recursive: true });
  return path;
}

export const text = (page, selector) => page.locator(selector).evaluate((node) => node.tagName === 'OUTPUT' ? node.value : node.textContent);
