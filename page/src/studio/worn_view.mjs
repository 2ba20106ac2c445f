// SPDX-License-Identifier: MIT
// The studio's view as the headset takes it (WornView of xr/headset.mjs): surfaces of the server as meshes and materials.
import * as THREE from 'three';
import { MeshoptSimplifier } from 'meshoptimizer/simplifier';
import { decodeHeight } from '../data.mjs';
import { eyePoint } from '../eye_point.mjs';
import { Surface } from '../surface.mjs';
import { MOST_TRIANGLES } from '../xr/budget.mjs';
import { hasCoordinates } from './surface_look.mjs';

/** Surfaces come in bursts; they are taken together. */
const BURST_MS = 50;
/** Of what fits, as simplification may stop before. */
const MARGIN = 0.9;
const NOTHING = new Uint32Array();
/** In place of a look that nothing has any more. */
const GONE = { name: '', haptic: null, relief: null };

/** Fewer triangles of the same vertices, borders in place; clusters where these allow too little. */
function simplified(indices, positions, share) {
  const wanted = 3 * Math.max(1, Math.floor(share * indices.length / 3)), [kept] = MeshoptSimplifier.simplify(indices, positions, 3, wanted, 1);
  return kept.length <= 2 * wanted ? kept : MeshoptSimplifier.simplifySloppy(indices, positions, 3, null, wanted, 1)[0];
}

export class WornView {
  /** Until then no triangles can be left out. */
  ready = MeshoptSimplifier.ready;

  /** @param view of the studio @param say(text, isProblem) */
  constructor(view, say) {
    const { renderer, camera, canvas, world, stage, root } = view;
    Object.assign(this, { view, say, renderer, camera, canvas, world, scene: stage, root, marks: [], looks: [], materials: [], standard: [], parts: [], numbers: new Map(), reliefs: new Map(), share: 1 });
    this.plain = new THREE.MeshStandardMaterial({ color: 0x9aa3ad, roughness: 0.8 });
    this.outline = new THREE.Box3Helper(new THREE.Box3(), 0xff8c00);
    this.outline.visible = false;
    this.scene.add(this.outline);
    this.take();
  }

  /** The number of a look: surfaces of the same have one material. */
  numberOf(look) {
    const name = JSON.stringify(look, (key, value) => key === 'image' ? null : value);  // Pictures have names.
    if (!this.numbers.has(name)) {
      this.numbers.set(name, this.looks.length);
      this.looks.push({ ...look, relief: null });
      this.standard.push(this.plain);
    }
    return this.numbers.get(name);
  }

  /** A surface of the server as Mesh of the headset. */
  meshOf({ arrays, look }, geometry) {
    const view = this, { positions, normals, uv, uv1 = uv, indices } = arrays;
    const data = {
      positions, normals, uv, uv1, indices, measured: geometry.getAttribute('measured').array,
      get coarse() { return view.share < 1 ? this.fewer ??= simplified(indices, positions, view.share) : NOTHING; },
    };
    return { material: this.numberOf(look), uv: hasCoordinates(arrays), vertices: positions.length / 3, data };
  }

  /** Of a surface that the view shows. */
  meshAt(key) {
    const surface = this.view.surfaces.get(key);
    return surface.mesh ??= this.meshOf(surface.data, surface.geometry);
  }

  /** Takes the surfaces that the view shows now. */
  take() {
    const { view } = this, shown = [...view.surfaces.values()].filter(({ key }) => !view.hidden.has(key));
    this.standard.fill(this.plain);
    for (const surface of shown) {
      const mesh = this.meshAt(surface.key), { material } = mesh;
      for (const object of surface.meshes) object.userData.mesh = mesh;
      if (this.standard[material] === this.plain) this.standard[material] = surface.material;
    }
    if (this.second && this.standard[this.second.mesh.material] === this.plain) this.standard[this.second.mesh.material] = this.second.standard;
    this.materials = this.looks.map((look, i) => this.standard[i] === this.plain ? GONE : look);
    this.parts = shown.map(({ mesh }) => ({ meshes: [mesh] }));
    const triangles = shown.reduce((sum, { mesh, meshes }) => sum + meshes.length * mesh.data.indices.length / 3, 0);
    this.share = triangles <= MOST_TRIANGLES ? 1 : MARGIN * MOST_TRIANGLES / triangles;
    this.surface = new Surface(shown.flatMap(({ meshes }) => meshes), this.scene);
  }

  /** Height maps of what is shown, one after the other; those that can't be had are told. */
  async loadReliefs(surfaces = [...this.view.surfaces.values()]) {
    for (const { data: { look }, files } of surfaces) {
      const material = this.looks[this.numberOf(look)], tag = look.haptic?.height;
      if (!tag || material.relief) continue;
      const name = JSON.stringify(tag);
      if (!this.reliefs.has(name)) this.reliefs.set(name, files.height().then((png) => decodeHeight(new Uint8Array(png), tag)).catch((error) => { this.say(error.message, true); return null; }));
      material.relief = await this.reliefs.get(name);
    }
  }

  /** Before a headset draws the scene, and after it has. */
  wear(on) {
    const { view } = this;
    view.wear(on);
    if (on) {
      this.planes = this.renderer.clippingPlanes;  // in millimetres: sections stay on the desk
      this.renderer.clippingPlanes = [];
      this.take();
      this.box = view.box();
      if (this.box.isEmpty()) this.box.set(new THREE.Vector3(-1e3, 0, -1e3), new THREE.Vector3(1e3, 2e3, 1e3));
      this.seat = this.seatOf();
      this.loadReliefs();
    } else this.renderer.clippingPlanes = this.planes;
    view.onSurfaces = on ? () => this.takeSoon() : null;
    this.outline.visible = false;
    this.invalidate();
  }

  /** Before the headrest at the wheel; else where the server found eyes, if it did. */
  seatOf() {
    const { scene } = this.view, names = (scene?.uses ?? []).map(({ part }) => scene.parts[part].name);
    const objects = this.surface.places.map(({ object }) => object), found = objects.length ? eyePoint(objects, names, this.box) : null;
    if (found || !scene?.eye) return found;
    const { eye, target } = this.view.seated();
    return { eye, ahead: target.sub(eye).setY(0).normalize() };
  }

  takeSoon() {
    clearTimeout(this.taking);
    this.taking = setTimeout(() => {
      this.take();
      this.onSurfaces?.();
      this.loadReliefs();
    }, BURST_MS);
  }

  /** Draws the box of a surface at its use. */
  outlineOf({ object, place: { toScene } }) {
    this.outline.box.copy(object.geometry.boundingBox).applyMatrix4(toScene);
    this.outline.visible = this.renderer.xr.isPresenting;
  }

  invalidate() { this.view.draw(); }
}
