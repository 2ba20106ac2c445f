// SPDX-License-Identifier: MIT
// The scene in 3D: surfaces as they come from the server, the camera, picking, sections. Drawn only when something changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { uvMatrix } from '../shading.mjs';
import { Lights } from './lights.mjs';
import { applyOverlay, overlayShader, rangeOf } from './overlay.mjs';

const GL_WRAP = { 33071: THREE.ClampToEdgeWrapping, 33648: THREE.MirroredRepeatWrapping };
const WALK_MM_PER_S = 900, LOOK_PER_PX = 0.004;
const AHEAD = /dash|instrument|cluster|steer|windscreen|windshield/i;

export class View {
  /** @param onPick called with {key, use, point, normal} or null, and the event */
  constructor(canvas, onPick) {
    Object.assign(this, { canvas, onPick, surfaces: new Map(), uses: [], mode: 'orbit', overlay: 'textured', map: 'viridis', seams: false, selected: new Set(), hidden: new Set(), pictures: new Map() });
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.world = new THREE.Scene();
    this.root = new THREE.Group();  // Turns the file's axes to Y up; everything in it is in millimetres.
    this.world.add(this.root);
    this.camera = new THREE.PerspectiveCamera(50, 1, 1, 1e5);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.lights = new Lights(this.renderer, this.world);
    this.lights.use('studio');
    this.lines = new THREE.LineBasicMaterial({ color: 0xe5007d, depthTest: true });
    this.keys = new Set();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  // ---- The scene.

  setScene(scene) {
    this.root.clear();
    for (const shown of this.surfaces.values()) this.drop(shown);
    this.surfaces.clear();
    this.hidden.clear();
    this.scene = scene;
    this.root.rotation.x = scene?.z_up ? -Math.PI / 2 : 0;
    this.root.updateMatrixWorld(true);
  }

  drop(shown) {
    for (const mesh of shown.meshes) mesh.removeFromParent();
    for (const line of shown.lines) line.removeFromParent();
    shown.geometry?.dispose();
    shown.seamGeometry?.dispose();
  }

  /** Shows a surface's arrays and look at its uses. @param key what it stands for: "part/slot/uses" */
  async setSurface(key, data, uses, texture) {
    const { arrays } = data, geometry = new THREE.BufferGeometry();
    const measured = new Float32Array(arrays.measured.length * 1.5);
    for (let i = 0; i < arrays.measured.length / 2; ++i) measured.set([arrays.measured[2 * i], arrays.measured[2 * i + 1], -1], 3 * i);
    geometry.setAttribute('position', new THREE.BufferAttribute(arrays.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(arrays.normals, 3));
    geometry.setAttribute('uv', new THREE.BufferAttribute(arrays.uv, 2));
    geometry.setAttribute('uv1', geometry.getAttribute('uv'));
    geometry.setAttribute('measured', new THREE.BufferAttribute(measured, 3));
    geometry.setIndex(new THREE.BufferAttribute(arrays.indices, 1));
    const hasUv = arrays.uv.some((x, i) => x !== i % 2);
    const material = await this.materialOf(data.look, texture);
    const shader = overlayShader(hasUv, data.mm_per_uv);
    const seamGeometry = new THREE.BufferGeometry();
    seamGeometry.setAttribute('position', new THREE.BufferAttribute(arrays.seams, 3));
    const before = this.surfaces.get(key);
    const shown = { key, data, uses, geometry, seamGeometry, material, shader, measured: arrays.measured, meshes: [], lines: [] };
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
      shown.meshes.push(mesh);
      shown.lines.push(line);
    }
    if (before) this.drop(before);
    this.surfaces.set(key, shown);
    this.dress(shown);
    this.draw();
  }

  /** Takes away the surfaces that are not of these keys. */
  keepOnly(keys) {
    for (const [key, shown] of this.surfaces)
      if (!keys.has(key)) {
        this.drop(shown);
        this.surfaces.delete(key);
      }
    this.draw();
  }

  async materialOf(look, texture) {
    const [r, g, b, a] = look.color, blend = look.alpha_mode === 'BLEND';
    const material = new THREE.MeshStandardMaterial({
      color: new THREE.Color(r, g, b), roughness: look.roughness, metalness: look.metallic, emissive: new THREE.Color(...look.emissive),
      side: look.double_sided ? THREE.DoubleSide : THREE.FrontSide, transparent: blend, opacity: blend ? a : 1, depthWrite: !blend,
      alphaTest: look.alpha_mode === 'MASK' ? look.alpha_cutoff : 0,
    });
    const [base, normal, shine] = await Promise.all([this.mapOf(look.base_map, true, texture), this.mapOf(look.normal_map, false, texture), this.mapOf(look.shine_map, false, texture)]);
    material.map = base;
    material.normalMap = normal;
    if (normal) material.normalScale.set(look.normal_map.factor, -look.normal_map.factor);  // Without tangents v runs the other way.
    material.roughnessMap = material.metalnessMap = shine;
    return material;
  }

  /** A picture as a texture; the same picture is decoded once. */
  async mapOf(map, isColour, texture) {
    if (!map) return null;
    const name = `${map.name}${isColour}`;
    if (!this.pictures.has(name))
      this.pictures.set(name, texture(map.image).then((blob) => createImageBitmap(blob, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' })).catch(() => null));
    const bitmap = await this.pictures.get(name);
    if (!bitmap) return null;
    const made = new THREE.Texture(bitmap);
    made.flipY = false;
    made.colorSpace = isColour ? THREE.SRGBColorSpace : THREE.NoColorSpace;
    [made.wrapS, made.wrapT] = map.wrap.map((w) => GL_WRAP[w] ?? THREE.RepeatWrapping);
    made.anisotropy = Math.min(8, this.renderer.capabilities.getMaxAnisotropy());
    made.matrixAutoUpdate = false;
    made.matrix.copy(uvMatrix(map));
    made.needsUpdate = true;
    return made;
  }

  // ---- How it is shown.

  dress(shown) {
    const textured = this.overlay === 'textured';
    if (!textured) applyOverlay(shown.shader, this.overlay, this.range ?? [0, 1], this.map);
    const glows = this.selected.has(shown.key);
    shown.material.emissive.setRGB(...(glows ? [0.004, 0.02, 0.05] : shown.data.look.emissive));
    for (const mesh of shown.meshes) {
      mesh.material = textured ? shown.material : shown.shader;
      mesh.visible = !this.hidden.has(shown.key);
    }
    for (const line of shown.lines) line.visible = this.seams && !this.hidden.has(shown.key);
  }

  dressAll() {
    this.range = this.overlay === 'textured' ? null : rangeOf(this.overlay, [...this.surfaces.values()].filter((s) => !this.hidden.has(s.key)));
    for (const shown of this.surfaces.values()) this.dress(shown);
    this.draw();
  }

  setOverlay(id, map = this.map) { Object.assign(this, { overlay: id, map }); this.dressAll(); return this.range; }
  setSeams(on) { this.seams = on; this.dressAll(); }
  setSelected(keys) { this.selected = keys; this.dressAll(); }
  setHidden(keys) { this.hidden = keys; this.dressAll(); }

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

  // ---- The camera.

  box(keys = null) {
    const box = new THREE.Box3();
    for (const shown of this.surfaces.values())
      if (keys ? keys.has(shown.key) : !this.hidden.has(shown.key)) for (const mesh of shown.meshes) box.expandByObject(mesh);
    return box;
  }

  frame(keys = null) {
    const box = this.box(keys);
    if (box.isEmpty()) return;
    this.setMode('orbit');
    const centre = box.getCenter(new THREE.Vector3()), radius = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1);
    const far = radius / Math.sin(THREE.MathUtils.degToRad(this.camera.fov / 2)) / Math.min(1, Math.max(this.camera.aspect, 0.4));
    this.near(radius);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(new THREE.Vector3(-0.7, 0.5, 0.75).normalize().multiplyScalar(0.8 * far));
    this.controls.update();
    this.draw();
  }

  near(radius) {
    this.camera.near = radius / 1000;
    this.camera.far = radius * 50;
    this.camera.updateProjectionMatrix();
  }

  /** Where a driver's eyes are: as the server found it, or in the middle; looking at what is ahead. */
  seat() {
    const box = this.box();
    if (box.isEmpty()) return;
    const eye = this.scene.eye ? this.root.localToWorld(new THREE.Vector3(...this.scene.eye)) : box.getCenter(new THREE.Vector3());
    const ahead = new THREE.Box3();
    for (const shown of this.surfaces.values()) if (AHEAD.test(shown.data.label)) for (const mesh of shown.meshes) ahead.expandByObject(mesh);
    const target = (ahead.isEmpty() ? box : ahead).getCenter(new THREE.Vector3());
    if (target.distanceTo(eye) < 1) target.z -= 100;
    this.near(box.getSize(new THREE.Vector3()).length() / 4);
    this.camera.position.copy(eye);
    this.setMode('walk');
    this.camera.lookAt(target);
    this.draw();
  }

  setMode(mode) {
    if (mode === 'orbit' && this.mode === 'walk') {
      const ahead = this.camera.getWorldDirection(new THREE.Vector3());
      const box = this.box(), far = box.isEmpty() ? 500 : box.getSize(new THREE.Vector3()).length() / 4;
      this.controls.target.copy(this.camera.position).addScaledVector(ahead, far);
    }
    this.mode = mode;
    this.controls.enabled = mode === 'orbit';
    if (mode === 'orbit') this.controls.update();
    this.draw();
  }

  look(dx, dy) {
    const angles = new THREE.Euler().setFromQuaternion(this.camera.quaternion, 'YXZ');
    angles.y += dx * LOOK_PER_PX;
    angles.x = THREE.MathUtils.clamp(angles.x + dy * LOOK_PER_PX, -1.5, 1.5);
    angles.z = 0;
    this.camera.quaternion.setFromEuler(angles);
    this.draw();
  }

  walk(seconds) {
    const ahead = this.camera.getWorldDirection(new THREE.Vector3()).setY(0).normalize(), right = new THREE.Vector3(-ahead.z, 0, ahead.x);
    const has = (...names) => names.some((name) => this.keys.has(name)) ? 1 : 0, way = WALK_MM_PER_S * seconds * (this.keys.has('shift') ? 0.2 : 1);
    this.camera.position.addScaledVector(ahead, way * (has('w', 'arrowup') - has('s', 'arrowdown')));
    this.camera.position.addScaledVector(right, way * (has('d', 'arrowright') - has('a', 'arrowleft')));
    this.camera.position.y += way * (has('e') - has('q'));
    this.draw();
  }

  orbitBy(azimuth, polar, scale) {
    const from = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
    from.theta += azimuth;
    from.phi = THREE.MathUtils.clamp(from.phi + polar, 0.02, Math.PI - 0.02);
    from.radius *= scale;
    this.camera.position.setFromSpherical(from).add(this.controls.target);
    this.controls.update();
  }

  key(event, down) {
    const name = event.key.toLowerCase();
    if (this.mode === 'walk') {
      if (!/^([wasdqe]|arrow\w+|shift)$/.test(name) || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      if (down) this.keys.add(name); else this.keys.delete(name);
      if (this.keys.size && !this.walking) this.startWalk();
    } else if (down) {
      const steps = { arrowleft: [-0.12, 0, 1], arrowright: [0.12, 0, 1], arrowup: [0, -0.12, 1], arrowdown: [0, 0.12, 1], '+': [0, 0, 0.85], '=': [0, 0, 0.85], '-': [0, 0, 1.18] };
      if (!steps[name]) return;
      event.preventDefault();
      this.orbitBy(...steps[name]);
    }
  }

  startWalk() {
    this.walking = true;
    let before = performance.now();
    const step = (now) => {
      this.walk(Math.min(0.1, (now - before) / 1000));
      before = now;
      if (this.keys.size) requestAnimationFrame(step); else this.walking = false;
    };
    requestAnimationFrame(step);
  }

  // ---- The mouse.

  hitAt(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - left) / width - 1, 1 - 2 * (event.clientY - top) / height), this.camera);
    const [plane] = this.renderer.clippingPlanes;
    const meshes = [...this.surfaces.values()].flatMap((shown) => shown.meshes).filter((mesh) => mesh.visible);
    const hit = ray.intersectObjects(meshes, false).find(({ point }) => !plane || plane.distanceToPoint(point) >= 0);
    if (!hit) return null;
    const normal = hit.face.normal.clone().transformDirection(hit.object.matrixWorld);
    if (normal.dot(ray.ray.direction) > 0) normal.negate();
    return { ...hit.object.userData, point: hit.point, normal };
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener('pointerdown', (event) => {
      this.down = { x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener('pointermove', (event) => {
      if (this.down && this.mode === 'walk' && event.buttons) this.look(event.movementX, event.movementY);
    });
    canvas.addEventListener('pointerup', (event) => {
      const { down } = this;
      this.down = null;
      if (down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 4) this.onPick(this.hitAt(event), event);
    });
    canvas.addEventListener('keydown', (event) => this.key(event, true));
    canvas.addEventListener('keyup', (event) => this.key(event, false));
    canvas.addEventListener('blur', () => this.keys.clear());
  }

  // ---- Drawing.

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.world.background = this.lights.back === null ? this.pageColour ?? null : new THREE.Color(this.lights.back);
      this.renderer.render(this.world, this.camera);
      this.canvas.dataset.frames = Number(this.canvas.dataset.frames ?? 0) + 1;
    });
  }
}

export { THREE };
