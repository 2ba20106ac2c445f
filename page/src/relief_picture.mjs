// SPDX-License-Identifier: MIT
// A relief as a picture, lit from the upper left.
export function drawRelief(canvas, relief, size) {
  const { width, height, mm } = relief, context = canvas.getContext('2d');
  const picture = context.createImageData(canvas.width, canvas.height);
  let low = Infinity, high = -Infinity;
  for (const h of mm) { low = Math.min(low, h); high = Math.max(high, h); }
  const pitch = size[0] / width, steep = 0.35 * Math.max(high - low, 1e-9) / (pitch * 8);
  const at = (x, y) => mm[((y + height) % height) * width + (x + width) % width];
  for (let j = 0; j < canvas.height; ++j)
    for (let i = 0; i < canvas.width; ++i) {
      const x = Math.floor(i * width / canvas.width), y = Math.floor(j * height / canvas.height);
      const dx = (at(x + 1, y) - at(x - 1, y)) / (2 * pitch), dy = (at(x, y + 1) - at(x, y - 1)) / (2 * pitch);
      const gain = Math.min(4, 0.5 / Math.max(steep, 1e-6)), nx = -dx * gain, ny = -dy * gain;
      const light = Math.max(0, (-0.5 * nx - 0.5 * ny + 0.7) / Math.hypot(nx, ny, 1));
      const tone = 40 + 190 * Math.min(1, light * (0.75 + 0.25 * (at(x, y) - low) / Math.max(high - low, 1e-9)));
      picture.data.set([tone, tone, tone, 255], 4 * (j * canvas.width + i));
    }
  context.putImageData(picture, 0, 0);
}
