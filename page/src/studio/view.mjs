// SPDX-License-Identifier: MIT
// The scene in 3D: surfaces as they come from the server, how they are dressed, sections. Drawn only when something changed.
import * as THREE from 'three';
import { Pace } from '../pace.mjs';
import { drawsInSoftware } from '../software_drawing.mjs';
import { Levels } from './levels.mjs';
import { Lights } from './lights.mjs';
import { MovingCamera } from './moving_camera.mjs';
import { quickRaycast } from './quick_raycast.mjs';
import { applyOverlay, overlayShader, rangeOf } from './overlay.mjs';
import { hitOf, rayAt } from './picking.mjs';
import { SurfaceLooks, geometryOf, hasCoordinates } from './surface_look.mjs';

const AHEAD = /dash|instrument|cluster|steer|windscreen|windshield/i;

export class View extends MovingCamera {
  /** @param onPick called with {key, use, point, normal} or null, and the event @param onProblem gets an Error of what was not fetched */
  constructor(canvas, onPick, onProblem) {
    super(canvas);
    Object.assign(this, { onPick, surfaces: new Map(), coming: new Map(), uses: [], overlay: 'textured', map: 'viridis', seams: false, selected: new Set(), hidden: new Set(), marks: [] });
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !drawsInSoftware() });
    this.pace = new Pace(this.renderer, (isCoarse) => { this.levels.rest(!isCoarse); this.resize(); });
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.world = new THREE.Scene();
    this.root = new THREE.Group();  // Turns the file's axes to Y up.
    this.stage = new THREE.Group();  // Everything in it is in millimetres; a headset shows it in metres.
    this.stage.add(this.root);
    this.world.add(this.stage);
    this.looks = new SurfaceLooks();
    this.levels = new Levels(this.surfaces, () => this.draw(), onProblem);
    this.lights = new Lights(this.renderer, this.world);
    this.lights.use('studio');
    this.lines = new THREE.LineBasicMaterial({ color: 0xe5007d, depthTest: true });
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  // ---- The scene.

  setScene(scene) {
    this.root.clear();
    for (const shown of this.surfaces.values()) this.drop(shown);
    this.surfaces.clear();
    this.coming.clear();
    this.hidden.clear();
    this.scene = scene;
    this.looks.clear();
    this.root.rotation.x = scene?.z_up ? -Math.PI / 2 : 0;
    this.root.updateMatrixWorld(true);
    this.changed();
  }

  drop(shown) {
    for (const mesh of shown.meshes) mesh.removeFromParent();
    for (const line of shown.lines) line.removeFromParent();
    this.levels.drop(shown);
    shown.geometry?.dispose();
    shown.seamGeometry?.dispose();
  }

  /** Shows a surface's arrays and look at its uses. @param key what it stands for: "part/slot/uses" @param files of filesOf() */
  async setSurface(key, data, uses, files) {
    this.coming.set(key, data);
    const { arrays } = data, geometry = geometryOf(arrays), hasUv = hasCoordinates(arrays);
    const material = await this.looks.materialOf(data.look, files.picture);
    if (this.coming.get(key) !== data) return;  // A newer one may have been there first.
    const shader = overlayShader(hasUv, data.mm_per_uv);
    const seamGeometry = new THREE.BufferGeometry();
    seamGeometry.setAttribute('position', new THREE.BufferAttribute(arrays.seams, 3));
    const before = this.surfaces.get(key);
    const shown = { key, data, uses, files, hasUv, geometry, seamGeometry, material, shader, measured: arrays.measured, meshes: [], lines: [] };
    for (const use of uses) {
      const matrix = new THREE.Matrix4().set(...this.scene.uses[use].world);
      const mesh = new THREE.Mesh(geometry, material), line = new THREE.LineSegments(seamGeometry, this.lines);
      for (const object of [mesh, line]) {
        object.matrixAutoUpdate = false;
        object.matrix.copy(matrix);
        this.root.add(object);
        object.updateMatrixWorld(true);
      }
      mesh.userData = { key, use };
      mesh.raycast = quickRaycast;
      shown.meshes.push(mesh);
      shown.lines.push(line);
    }
    if (before) this.drop(before);
    this.surfaces.set(key, shown);
    this.dress(shown);
    this.changed();
  }

  /** Other surfaces are there than before. */
  changed() {
    this.onSurfaces?.();
    this.changing();
  }

  /** Takes away the surfaces that are not of these keys. */
  keepOnly(keys) {
    for (const [key, shown] of this.surfaces)
      if (!keys.has(key)) {
        this.drop(shown);
        this.surfaces.delete(key);
        this.coming.delete(key);
      }
    this.changed();
  }

  // ---- How it is shown.

  dress(shown) {
    const textured = this.overlay === 'textured';
    if (!textured) applyOverlay(shown.shader, this.overlay, this.range ?? [0, 1], this.map);
    const glows = this.selected.has(shown.key) && !this.isWorn;
    shown.material.emissive.setRGB(...(glows ? [0.004, 0.02, 0.05] : shown.data.look.emissive));
    for (const mesh of shown.meshes) {
      mesh.material = textured ? shown.material : shown.shader;
      mesh.geometry = textured && shown.laid ? shown.laid : shown.geometry;
      mesh.visible = !this.hidden.has(shown.key) && !this.isWorn;
    }
    for (const line of shown.lines) line.visible = this.seams && !this.hidden.has(shown.key) && !this.isWorn;
  }

  /** Shows the same triangles with other coordinates. @param geometry that has them; null: the surface's own */
  lay(shown, geometry) {
    if ((shown.laid ?? null) === geometry) return;
    shown.laid = geometry;
    this.dress(shown);
  }

  dressAll() {
    this.range = this.overlay === 'textured' ? null : rangeOf(this.overlay, [...this.surfaces.values()].filter((s) => !this.hidden.has(s.key)));
    for (const shown of this.surfaces.values()) this.dress(shown);
    this.draw();
  }

  setOverlay(id, map = this.map) { Object.assign(this, { overlay: id, map }); this.dressAll(); return this.range; }
  setSeams(on) { this.seams = on; this.dressAll(); }
  setSelected(keys) { this.selected = keys; this.dressAll(); }
  setHidden(keys) { this.hidden = keys; this.dressAll(); this.changed(); }

  /** A headset shows other objects in place of the surfaces, and draws by itself. */
  wear(on) {
    this.isWorn = on;
    this.dressAll();
    if (on) return;
    this.pace.setCoarse(false);
    this.resize();
  }

  /** @param axis 'x', 'y', 'z' of the world, or 'off' @param share of the scene's extent */
  setSection(axis, share) {
    const box = this.box(), planes = [];
    if (axis !== 'off' && !box.isEmpty()) {
      const normal = new THREE.Vector3(axis === 'x' ? -1 : 0, axis === 'y' ? -1 : 0, axis === 'z' ? -1 : 0);
      planes.push(new THREE.Plane(normal, box.min[axis] + share * (box.max[axis] - box.min[axis])));
    }
    this.renderer.clippingPlanes = planes;
    this.draw();
  }

  setLight(name) { this.lights.use(name); this.draw(); }
  async setOwnLight(file) { await this.lights.useOwn(file); this.draw(); }
  setBackground(css) { this.pageColour = new THREE.Color(css); this.draw(); }

  // ---- Where it is.

  box(keys = null) {
    const box = new THREE.Box3();
    for (const shown of this.surfaces.values())
      if (keys ? keys.has(shown.key) : !this.hidden.has(shown.key)) for (const mesh of shown.meshes) box.expandByObject(mesh);
    return box;
  }

  /** Where a driver's eyes are, as the server found it, or the middle; and what they look at. */
  seated() {
    const box = this.box(), eye = this.scene.eye ? this.root.localToWorld(new THREE.Vector3(...this.scene.eye)) : box.getCenter(new THREE.Vector3());
    const ahead = new THREE.Box3();
    for (const shown of this.surfaces.values()) if (AHEAD.test(shown.data.label)) for (const mesh of shown.meshes) ahead.expandByObject(mesh);
    const target = (ahead.isEmpty() ? box : ahead).getCenter(new THREE.Vector3());
    if (target.distanceTo(eye) < 1) target.z -= 100;
    return { eye, target };
  }

  // ---- The mouse.

  rayAt(place) { return rayAt(place, this.canvas, this.camera); }
  hitAt(place) { return this.hitOf(this.rayAt(place)); }

  hitOf(ray) {
    const meshes = [...[...this.surfaces.values()].flatMap((shown) => shown.meshes).filter((mesh) => mesh.visible), ...this.standIns?.pickable() ?? []];
    return hitOf(ray, meshes, this.renderer.clippingPlanes);
  }

  /** A press and release in the same place picks; a drag looks around where one walks. */
  listen() {
    const { canvas } = this;
    canvas.addEventListener('pointerdown', ({ clientX, clientY }) => { this.down = { x: clientX, y: clientY }; });
    canvas.addEventListener('pointermove', (event) => {
      if (this.down && this.mode === 'walk' && event.buttons) this.look(event.movementX, event.movementY);
    });
    canvas.addEventListener('pointerup', (event) => {
      const { down } = this;
      this.down = null;
      if (down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 4) this.onPick(this.hitAt(event), event);
    });
  }

  // ---- Drawing.

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height || this.renderer.xr.isPresenting) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Draws what changes with more to follow soon. */
  changing() {
    this.pace.changing();
    this.draw();
  }

  draw() {
    if (this.waiting || this.renderer.xr.isPresenting) return;
    this.waiting = true;
    if (this.pace.isHeld) this.pace.changing();
    requestAnimationFrame(() => {
      this.waiting = false;
      if (!this.renderer.xr.isPresenting) this.pace.draw(() => this.paint());
    });
  }

  /** Distortion and seams are those of whole surfaces. */
  paint() {
    this.world.background = this.lights.back === null ? this.pageColour ?? null : new THREE.Color(this.lights.back);
    for (const mark of this.marks) mark.fit();
    this.levels.draw(this.camera, this.overlay !== 'textured' || this.seams, () => this.renderer.render(this.world, this.camera));
    const { dataset } = this.canvas;
    Object.assign(dataset, { frames: Number(dataset.frames ?? 0) + 1, triangles: this.renderer.info.render.triangles, missingLevels: this.levels.missing });
  }
}

export { THREE };
