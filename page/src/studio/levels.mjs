// SPDX-License-Identifier: MIT
// Levels of detail: what is small in the picture is drawn with fewer of its triangles. The server makes them, when a picture
// wants them; everything but the picture meets whole surfaces.
import * as THREE from 'three';
import { levelDistance } from '../level_distance.mjs';

/** Fewer are not worth a request. */
const LEAST_TRIANGLES = 200;
/** While many come, a picture is drawn with those that are there this often. */
const REDRAW_MS = 1000;

/** A geometry of fewer triangles over the same vertices. */
function coarser(geometry, indices) {
  const level = new THREE.BufferGeometry();
  for (const [name, attribute] of Object.entries(geometry.attributes)) level.setAttribute(name, attribute);
  level.setIndex(new THREE.BufferAttribute(indices, 1));
  level.boundingSphere = geometry.boundingSphere;
  return level;
}

/** The sphere around a surface's box, which is what levels are chosen by. */
function sphereOf({ geometry }) {
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry.boundingBox.getBoundingSphere(new THREE.Sphere());
}

const sphere = new THREE.Sphere();

export class Levels {
  /** @param surfaces of a View @param onCome called when a picture would be another @param onProblem gets an Error */
  constructor(surfaces, onCome, onProblem) { Object.assign(this, { surfaces, onCome, onProblem, wanted: [], asked: null, isHeld: false, isAtRest: true, drawnAt: 0 }); }

  /** What lies on a surface needs the whole of it: set by who lays something there. @param shown a surface @param use */
  isCovered() { return false; }

  /** Levels that the last picture wants and does not have yet. */
  get missing() { return this.wanted.length + (this.asked ? 1 : 0); }

  /** While the server has surfaces to make it is asked for no levels. */
  hold(isHeld) {
    this.isHeld = isHeld;
    this.ask();
  }

  /** Nor while pictures are coarse: the server would take processors from them. */
  rest(isAtRest) {
    this.isAtRest = isAtRest;
    this.ask();
  }

  /** Draws a picture in which every mesh has the level that its size asks for. @param isExact then all are whole */
  draw(camera, isExact, draw) {
    const chosen = [];
    this.wanted = [];
    if (!isExact) for (const shown of this.surfaces.values()) this.choose(shown, camera, chosen);
    for (const { mesh, level } of chosen) mesh.geometry = level.geometry;
    draw();
    for (const { mesh, whole } of chosen) mesh.geometry = whole;
    this.drawnAt = performance.now();
    this.ask();
  }

  choose(shown, camera, chosen) {
    const { geometry: whole } = shown, isKnown = Boolean(shown.levels);
    if (shown.laid || whole.index.count < 3 * LEAST_TRIANGLES) return;
    shown.sphere ??= sphereOf(shown);
    let isWanted = false;
    for (const mesh of shown.meshes) {
      if (!mesh.visible || this.isCovered(shown, mesh.userData.use)) continue;
      const { center, radius } = sphere.copy(shown.sphere).applyMatrix4(mesh.matrixWorld), distance = center.distanceTo(camera.position) / camera.zoom;
      const level = shown.levels?.findLast(({ coverage }) => distance > levelDistance(radius, coverage, camera.fov));
      if (level) chosen.push({ mesh, level, whole });
      isWanted ||= !isKnown && distance > levelDistance(radius, 1, camera.fov);
    }
    if (isWanted && shown !== this.asked) this.wanted.push(shown);
  }

  /** The next request, for the most triangles first. */
  async ask() {
    if (this.asked || this.isHeld || !this.isAtRest) return;
    this.wanted = this.wanted.filter((shown) => this.surfaces.get(shown.key) === shown).sort((a, b) => a.geometry.index.count - b.geometry.index.count);
    const shown = this.asked = this.wanted.pop();
    if (!shown) return;
    try {
      shown.levels = (await shown.files.levels()).map(({ coverage, indices }) => ({ coverage, geometry: coarser(shown.geometry, indices) }));
    } catch (error) {
      shown.levels = [];
      this.onProblem(error);
    }
    this.asked = null;
    if (!this.wanted.length || performance.now() - this.drawnAt > REDRAW_MS) this.onCome();
    this.ask();
  }

  drop({ levels }) { for (const { geometry } of levels ?? []) geometry.dispose(); }
}
