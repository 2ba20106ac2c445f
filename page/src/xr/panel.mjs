// SPDX-License-Identifier: MIT
// Text in the headset: the menu in the hand, and the name at the pointer. Letters take more than a degree, so that they
// can be read at 20 pixels a degree.
import * as THREE from 'three';

const WIDTH_PX = 640, ROW_PX = 56, FONT_PX = 32;
/** Of the menu (m): held at half a metre, a letter of 32 px is 1.3 degrees high. */
const WIDTH_M = 0.23;
export const EM_M = FONT_PX * WIDTH_M / WIDTH_PX;
/** Of names: degrees that their letters take wherever they are. */
const NAME_DEGREES = 1.4;

function textured(width, height) {
  const canvas = Object.assign(document.createElement('canvas'), { width, height }), map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  map.anisotropy = 4;
  const material = new THREE.MeshBasicMaterial({ map, transparent: true, toneMapped: false, depthTest: false, side: THREE.DoubleSide });
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), material);
  mesh.renderOrder = 30;
  return { canvas, map, mesh };
}

export class Menu {
  /** @param rows a function that gives [{text, on, run}], or rows of such */
  constructor(rows) {
    this.rows = rows;
    Object.assign(this, textured(WIDTH_PX, ROW_PX));
    this.mesh.position.set(0, 0.14, -0.05);
    this.mesh.rotation.x = -0.6;
    this.draw();
  }

  /** As high as its rows are. */
  fit(rows) {
    if (this.canvas.height === ROW_PX * rows) return;
    this.canvas.height = ROW_PX * rows;
    this.map.dispose();
    this.mesh.scale.set(WIDTH_M, WIDTH_M * this.canvas.height / WIDTH_PX, 1);
  }

  draw() {
    const rows = this.rows(), context = this.canvas.getContext('2d');
    this.fit(rows.length);
    context.fillStyle = '#12161b';
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    context.font = `${FONT_PX}px sans-serif`;
    context.textBaseline = 'middle';
    this.cells = rows.map((row) => [row].flat()).flatMap((row, j) => row.map((cell, i) => ({ ...cell, x: i * WIDTH_PX / row.length, y: j * ROW_PX, width: WIDTH_PX / row.length })));
    this.cells.forEach(({ text, on, run, x, y, width }, i) => {
      context.fillStyle = on ? '#7cb8ff' : i === this.under && run ? '#46515e' : run ? '#252c34' : '#12161b';
      context.fillRect(x + 3, y + 3, width - 6, ROW_PX - 6);
      context.fillStyle = on ? '#0b1a2b' : '#ffffff';
      context.fillText(text, x + 14, y + ROW_PX / 2, width - 28);
    });
    this.map.needsUpdate = true;
  }

  /** The ray of the pointer, of the world. @returns whether it meets the menu */
  point(caster) {
    const [hit] = caster.intersectObject(this.mesh);
    const at = hit ? this.cells.findIndex(({ x, y, width }) => {
      const px = hit.uv.x * WIDTH_PX, py = (1 - hit.uv.y) * this.canvas.height;
      return px >= x && px < x + width && py >= y && py < y + ROW_PX;
    }) : -1;
    if (at !== this.under) {
      this.under = at;
      this.draw();
    }
    return hit?.distance ?? null;
  }

  press() {
    const run = this.cells[this.under]?.run;
    run?.();
    this.draw();
    return Boolean(run);
  }
}

/** The name of what the pointer is at. */
export class NameTag {
  constructor() { Object.assign(this, textured(WIDTH_PX, ROW_PX)); }

  /** @param place of the world (m), @param head the camera's place */
  show(text, place, head) {
    if (text !== this.text) {
      const context = this.canvas.getContext('2d');
      context.clearRect(0, 0, WIDTH_PX, ROW_PX);
      context.font = `${FONT_PX}px sans-serif`;
      const width = Math.min(context.measureText(text).width + 28, WIDTH_PX);
      context.fillStyle = '#12161be0';
      context.fillRect((WIDTH_PX - width) / 2, 0, width, ROW_PX);
      context.fillStyle = '#fff';
      context.textAlign = 'center';
      context.textBaseline = 'middle';
      context.fillText(text, WIDTH_PX / 2, ROW_PX / 2, WIDTH_PX - 28);
      this.map.needsUpdate = true;
      this.text = text;
    }
    const metre = place.distanceTo(head) * Math.tan(NAME_DEGREES * Math.PI / 180) / FONT_PX;
    this.mesh.scale.set(WIDTH_PX * metre, ROW_PX * metre, 1);
    this.mesh.position.copy(place).add(new THREE.Vector3(0, 1.2 * ROW_PX * metre, 0));
    this.mesh.lookAt(head);
    this.mesh.visible = true;
  }

  hide() { this.mesh.visible = false; }
}
