// SPDX-License-Identifier: MIT
// The upper part of a report page as a browser shows it: node screenshot.mjs PAGE.html OUT.png
import { launch, open } from '../../tests/page/browser.mjs';

const [file, picture] = process.argv.slice(2);
const browser = await launch();
try {
  const { page } = await open(browser, file);
  await page.waitForSelector('#canvas3d[data-textures=loaded]');
  await page.waitForTimeout(3000);  // Software GL takes its time for a full frame.
  await page.screenshot({ path: picture });
} finally {
  await browser.close();
}
