// SPDX-License-Identifier: MIT
// The scene in 3D: drawn only when something changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { eyePoint } from './eye_point.mjs';
import { frontOf } from './framing.mjs';
import { levelDistance } from './level_distance.mjs';
import { addStudio } from './light.mjs';
import { Pace } from './pace.mjs';
import { applyView, shadingOf, sideOf } from './shading.mjs';
import { drawsInSoftware } from './software_drawing.mjs';
import { Surface } from './surface.mjs';
import { environmentTexture, pixelTexture, textureOf } from './textures.mjs';

/** Vertical angle of view, and its part where one sits inside: wider, as people look around. */
const FOV = 40, SEATED_ZOOM = 0.76, NARROW = 1.1;
/** From where an object without a room is looked at. */
const OUTSIDE = new THREE.Vector3(0.7, 0.55, 0.9);

export function geometryOf(mesh) {
  const { positions, normals, uv, uv1, measured, indices, coarse } = mesh.data;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  geometry.setAttribute('uv', new THREE.BufferAttribute(uv, 2));
  geometry.setAttribute('uv1', new THREE.BufferAttribute(uv1, 2));
  geometry.setAttribute('measured', new THREE.BufferAttribute(measured, 3));
  const both = new Uint32Array(indices.length + coarse.length);
  both.set(indices);
  both.set(coarse, indices.length);
  geometry.setIndex(new THREE.BufferAttribute(both, 1));
  geometry.setDrawRange(0, indices.length);
  return geometry;
}

/** Of mipmaps: grain of three pixels a wave is still seen. */
const SHARPER = -0.75;
const NORMALS = THREE.ShaderChunk.normal_fragment_maps.replaceAll('texture2D( normalMap, vNormalMapUv )', `texture2D( normalMap, vNormalMapUv, ${SHARPER} )`);

function sharpenGrain(shader) { shader.fragmentShader = shader.fragmentShader.replace('#include <normal_fragment_maps>', NORMALS); }

function standardMaterial(material) {
  if (!material) return new THREE.MeshStandardMaterial({ color: 0x9aa3ad, roughness: 0.8, side: sideOf(material) });
  const [r, g, b, a] = material.color;
  const blend = material.alpha_mode === 'BLEND';
  const common = {
    color: new THREE.Color(r, g, b), side: sideOf(material), transparent: blend, opacity: blend ? a : 1,
    depthWrite: !blend, alphaTest: material.alpha_mode === 'MASK' ? material.alpha_cutoff : 0,
  };
  if (material.unlit) return new THREE.MeshBasicMaterial({ ...common, toneMapped: false });
  const standard = new THREE.MeshStandardMaterial({
    ...common, roughness: material.roughness, metalness: material.metallic, emissive: new THREE.Color(...material.emissive),
  });
  standard.onBeforeCompile = sharpenGrain;
  return standard;
}

export class SceneView {
  /** @param onPick called with a spot of Surface, or null, @param onHover likewise */
  constructor(canvas, scene, onPick, onHover) {
    Object.assign(this, { canvas, data: scene, onPick, onHover, marks: [] });
    this.inSoftware = drawsInSoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.inSoftware });
    this.pace = new Pace(this.renderer, (coarse) => this.detail(coarse));
    this.renderer.toneMapping = THREE.NeutralToneMapping;  // keeps colours under white light, unlike curves of film
    this.world = new THREE.Scene();
    this.fov = FOV;
    this.camera = new THREE.PerspectiveCamera(FOV, 1, 0.1, 1e6);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.moved());
    this.addMeshes();
    this.addLights();
    this.addMarker();
    this.resize();
    this.seat = eyePoint(this.meshes, scene.instances.map((use) => use.name || scene.parts[use.part].name), this.box);
    this.goHome();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.loaded = this.loadTextures().catch((error) => { this.textureError = error.message; });
  }

  /** The scene's environment, or the page's studio, and those that materials have of their own. */
  addLights() {
    const generator = new THREE.PMREMGenerator(this.renderer);
    const lights = this.data.environments.map((picture) => generator.fromEquirectangular(environmentTexture(picture)).texture);
    this.data.materials.forEach(({ environment, unlit }, i) => { if (environment !== null && !unlit) this.standard[i].envMap = lights[environment]; });
    this.world.add(this.camera);
    if (this.data.environment !== null) this.world.environment = lights[this.data.environment];
    else addStudio(this.world, this.camera, generator);
  }

  addMeshes() {
    const { parts, instances, materials } = this.data;
    this.root = new THREE.Group();
    if (this.data.z_up) this.root.rotation.x = -Math.PI / 2;
    this.standard = materials.map(standardMaterial);
    this.plain = standardMaterial(null);
    this.meshes = [];
    for (const part of parts) for (const mesh of part.meshes) mesh.geometry = geometryOf(mesh);
    const places = this.data.levels.map(() => []);  // By place and number: groups of which one is shown.
    instances.forEach((use, index) => {
      const { place, number } = use.level ?? {};
      const host = use.level ? (places[place][number] ??= new THREE.Group()) : this.root;
      for (const mesh of parts[use.part].meshes) {
        const object = new THREE.Mesh(mesh.geometry, this.plain);
        object.matrixAutoUpdate = false;
        object.matrix.set(...use.world);
        mesh.shader ??= shadingOf(materials[mesh.material], mesh, false);
        object.userData = { use: index, mesh };
        this.meshes.push(object);
        host.add(object);
      }
    });
    this.data.levels.forEach((coverages, i) => this.addLevels(coverages, places[i]));
    this.scene = new THREE.Group();  // of mm; a headset shows it in metres
    this.scene.add(this.root);
    this.world.add(this.scene);
    this.scene.updateMatrixWorld(true);
    this.surface = new Surface(this.meshes, this.scene);
    this.box = new THREE.Box3().setFromObject(this.root);
    if (this.box.isEmpty()) this.box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
    this.size = this.box.getSize(new THREE.Vector3()).length();
  }

  /** Levels of detail by the share of the picture's height that the sphere around the finest one takes. */
  addLevels(coverages, groups) {
    if (!groups[0]) return;
    const { center, radius } = new THREE.Box3().setFromObject(groups[0]).getBoundingSphere(new THREE.Sphere());
    const lod = new THREE.LOD();
    lod.position.copy(center);
    for (let k = 0; k <= coverages.length; ++k) {
      const group = groups[k] ?? new THREE.Group();  // Below the last coverage there is nothing.
      group.position.copy(center).negate();
      const from = k === 0 ? 0 : levelDistance(radius, coverages[k - 1], this.camera.fov);
      if (Number.isFinite(from)) lod.addLevel(group, from);
    }
    this.root.add(lod);
  }

  addMarker() {
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(1, 16, 12), new THREE.MeshBasicMaterial({ color: 0xff3030, depthTest: false }));
    this.marker.renderOrder = 10;
    this.marker.visible = false;
    this.outline = new THREE.Box3Helper(new THREE.Box3(), 0xff8c00);
    this.outline.visible = false;
    this.scene.add(this.marker, this.outline);
  }

  /** A mirror ball in the light of the textured view, as sRGB rows from the top. */
  environmentPicture(side) {
    const target = new THREE.WebGLRenderTarget(side, side), world = new THREE.Scene(), camera = new THREE.PerspectiveCamera(30, 1, 0.1, 10);
    camera.position.z = 4.2;
    world.environment = this.world.environment;
    world.background = this.world.environment;
    world.add(new THREE.Mesh(new THREE.SphereGeometry(1, 64, 48), new THREE.MeshStandardMaterial({ metalness: 1, roughness: 0 })));
    this.renderer.setRenderTarget(target);
    this.renderer.render(world, camera);
    const linear = new Uint8Array(4 * side * side), picture = new ImageData(side, side);
    this.renderer.readRenderTargetPixels(target, 0, 0, side, side, linear);
    this.renderer.setRenderTarget(null);
    target.dispose();
    for (let i = 0; i < linear.length; ++i) {
      const [y, x] = [Math.floor(i / (4 * side)), i % (4 * side)];
      picture.data[4 * side * (side - 1 - y) + x] = i % 4 === 3 ? 255 : 255 * (linear[i] / 255) ** (1 / 2.2);
    }
    return picture;
  }

  async loadTextures() {
    const { materials } = this.data;
    for (const [i, material] of materials.entries()) {
      const standard = this.standard[i];
      standard.map = await textureOf(this.data, material.base_map, true);
      if (!material.unlit) {
        standard.normalMap = await textureOf(this.data, material.normal_map, false);
        if (material.normal_map) standard.normalScale.set(material.normal_map.factor, -material.normal_map.factor);  // Without tangents v runs the other way.
        standard.roughnessMap = standard.metalnessMap = await textureOf(this.data, material.shine_map, false);
      }
      standard.needsUpdate = true;
    }
    this.canvas.dataset.textures = 'loaded';
    this.invalidate();
  }

  /** Shows materials by other pixels, at the places of their pictures; done when they are drawn. */
  async setLooks(looks) {
    await this.loaded;
    for (const look of looks) {
      const standard = this.standard[look.material], place = this.data.materials[look.material].base_map;
      if (!standard.isMeshStandardMaterial || !place) continue;
      const had = [standard.map, standard.normalMap, standard.roughnessMap, standard.alphaTest].map(Boolean).join();
      if ('color' in look) standard.map = pixelTexture(standard.map, look.color, look, place, true);
      if (look.normal) standard.normalMap = pixelTexture(standard.normalMap, look.normal, look, place, false);
      if ('shine' in look) standard.roughnessMap = standard.metalnessMap = pixelTexture(standard.roughnessMap, look.shine, look, place, false);
      Object.assign(standard, { roughness: look.roughness, metalness: look.metallic });
      standard.color.setRGB(1, 1, 1);
      standard.transparent = look.alpha_mode === 'BLEND';
      standard.opacity = standard.transparent ? look.opacity : 1;
      standard.depthWrite = !standard.transparent;
      standard.alphaTest = look.alpha_mode === 'MASK' ? this.data.materials[look.material].alpha_cutoff : 0;
      if (had !== [standard.map, standard.normalMap, standard.roughnessMap, standard.alphaTest].map(Boolean).join()) standard.needsUpdate = true;
    }
    const drawn = new Promise((resolve) => { this.onDrawn = resolve; });
    this.moved();
    await drawn;
  }

  setView(view, range) {
    for (const object of this.meshes) {
      const { mesh } = object.userData, material = this.data.materials[mesh.material];
      object.material = view.kind === 0 ? (this.standard[mesh.material] ?? this.plain) : mesh.shader;
      applyView(mesh.shader, view, range, material);
    }
    this.canvas.dataset.view = view.id;
    this.invalidate();
  }

  setBackground(colour) { this.world.background = new THREE.Color(colour); this.invalidate(); }

  select(use, frame) {
    const box = new THREE.Box3();
    for (const { object, toScene } of this.surface.places) if (object.userData.use === use) box.union(object.geometry.boundingBox.clone().applyMatrix4(toScene));
    this.outline.visible = !box.isEmpty();
    if (box.isEmpty()) return;
    this.outline.box.copy(box);
    this.selected = { use, box };
    if (frame) this.frameSelected();
    this.invalidate();
  }

  mark(use, mesh, local) {
    const { toScene } = this.surface.places.find(({ object: { userData } }) => userData.use === use && userData.mesh === mesh);
    this.marker.position.copy(local).applyMatrix4(toScene);
    this.marker.visible = true;
    this.invalidate();
  }

  /** Shows the front of the selected part, or everything. */
  frameSelected() {
    if (!this.selected) return this.frameAll();
    const { use, box } = this.selected, from = this.camera.position.clone().sub(box.getCenter(new THREE.Vector3())).normalize();
    this.stand();
    const front = frontOf(this.surface, use, from, 1.25 * this.distanceTo(box, from));
    this.camera.position.copy(this.controls.target).add(front);
    return this.frame(box, 1.25);
  }

  /** The first view: from the driver's place, or the whole of an object. */
  goHome() {
    if (!this.seat) return this.frameAll();
    this.seated = true;
    this.controls.enableZoom = this.controls.enablePan = false;
    this.controls.rotateSpeed = -0.35;  // the hand takes the picture along
    this.camera.zoom = SEATED_ZOOM * Math.min(1, this.camera.aspect / NARROW);
    this.camera.position.copy(this.seat.eye);
    this.controls.target.copy(this.seat.eye).addScaledVector(this.seat.look, this.size * 1e-3);
    this.settle();
  }

  /** Gets up: the camera turns around what it looks at from now on. */
  stand() {
    if (this.seated) this.controls.target.sub(this.camera.position).setLength(this.size / 4).add(this.camera.position);
    this.seated = false;
    this.controls.enableZoom = this.controls.enablePan = true;
    this.controls.rotateSpeed = 1;
    this.camera.zoom = 1;
  }

  frameAll() {
    this.stand();
    const ahead = this.seat?.ahead, from = OUTSIDE.clone();
    if (ahead) from.set(-ahead.x, 0, -ahead.z).addScaledVector(new THREE.Vector3(ahead.z, 0, -ahead.x), 0.8).setY(0.9);  // from behind and above
    this.camera.position.copy(this.controls.target).add(from);
    this.frame(this.box, 1.03);
  }

  /** The uses that are seen, by how much of the picture they take. */
  seen() {
    const shares = new Map(), { ray } = this.caster ??= new THREE.Raycaster();
    this.camera.updateMatrixWorld();
    for (let i = 0; i < 81; ++i) {
      this.caster.setFromCamera(new THREE.Vector2((i % 9 - 4) / 5, (Math.floor(i / 9) - 4) / 5), this.camera);
      const use = this.surface.meet(ray.origin, ray.direction)?.use;
      if (use !== undefined) shares.set(use, (shares.get(use) ?? 0) + 1);
    }
    return [...shares.entries()].sort((a, b) => b[1] - a[1]).map(([use]) => use);
  }

  /** @param distance of what is turned around */
  lookFrom(eye, look, distance, zoom) {
    this.stand();
    this.camera.zoom = zoom;
    this.camera.position.copy(eye);
    this.controls.target.copy(eye).addScaledVector(look, distance);
    this.settle();
  }

  /** What is seen now as a JPEG in a data URL. */
  picture(width) {
    this.draw();
    const small = Object.assign(document.createElement('canvas'), { width, height: Math.round(width * this.canvas.height / this.canvas.width) });
    small.getContext('2d').drawImage(this.canvas, 0, 0, small.width, small.height);
    return small.toDataURL('image/jpeg', 0.8);
  }

  /** Before a headset draws the scene, and after it has. */
  wear(on) {
    this.outline.visible &&= !on;
    if (on) return;
    this.resize();
    this.settle();
  }

  settle() {
    this.camera.near = this.size / 2000;
    this.camera.far = this.size * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.moved();
  }

  /** How far from its centre the camera must be, on the way that it is, to see the whole box. */
  distanceTo(box, direction) {
    const half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5), tangent = Math.tan(this.camera.fov * Math.PI / 360);
    const right = new THREE.Vector3().crossVectors(this.camera.up, direction).normalize(), up = new THREE.Vector3().crossVectors(direction, right);
    let distance = this.size * 1e-4;
    for (const x of [-1, 1]) for (const y of [-1, 1]) for (const z of [-1, 1]) {
      const corner = new THREE.Vector3(x, y, z).multiply(half);
      distance = Math.max(distance, corner.dot(direction) + Math.max(Math.abs(corner.dot(up)), Math.abs(corner.dot(right)) / this.camera.aspect) / tangent);
    }
    return distance;
  }

  frame(box, margin) {
    this.stand();
    const centre = box.getCenter(new THREE.Vector3()), direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, margin * this.distanceTo(box, direction));
    this.settle();
  }

  /** The spot that is seen at a place of the canvas. */
  hitAt({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect(), { ray } = this.caster ??= new THREE.Raycaster();
    this.caster.setFromCamera(new THREE.Vector2((clientX - left) / width * 2 - 1, 1 - (clientY - top) / height * 2), this.camera);
    return this.surface.meet(ray.origin, ray.direction);
  }

  listen() {
    const { canvas } = this;
    let down = null, waiting = false;
    // Before the camera's own listeners, which take the pointer.
    canvas.addEventListener('pointerdown', (e) => {
      down = e;
      const spot = this.touch && e.button === 0 ? this.hitAt(e) : null;
      if (!spot) return;
      this.touching = e.pointerId;
      canvas.setPointerCapture(e.pointerId);
      e.stopImmediatePropagation();
      this.touch(spot);
    }, { capture: true });
    canvas.addEventListener('pointerup', (e) => {
      const still = down && Math.hypot(e.clientX - down.clientX, e.clientY - down.clientY) < 4;
      down = null;
      if (this.touching === e.pointerId) {
        this.touching = undefined;
        this.touch(null);
      } else if (still) this.onPick(this.hitAt(e));
    });
    canvas.addEventListener('pointercancel', () => {
      if (this.touching !== undefined) this.touch(null);
      this.touching = undefined;
    });
    canvas.addEventListener('pointermove', (e) => {
      if (this.touching === e.pointerId) return this.touch(this.hitAt(e));
      if (e.buttons || waiting) return;
      waiting = true;
      requestAnimationFrame(() => { waiting = false; this.onHover(this.hitAt(e)); });
    });
    canvas.addEventListener('wheel', (e) => {
      if (!this.seated) return;
      e.preventDefault();
      this.zoomBy(e.deltaY < 0 ? 1.1 : 1 / 1.1);
    }, { passive: false });
    canvas.addEventListener('keydown', (e) => this.onKey(e));
  }

  /** Nearer by a factor; seated, by a narrower view. */
  zoomBy(factor) {
    if (this.seated) {
      this.camera.zoom = Math.min(Math.max(this.camera.zoom * factor, 0.4), 8);
      this.camera.updateProjectionMatrix();
    } else {
      this.camera.position.sub(this.controls.target).divideScalar(factor).add(this.controls.target);
      this.controls.update();
    }
    this.moved();
  }

  onKey(event) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const offset = this.camera.position.clone().sub(this.controls.target), key = event.key.toLowerCase();
    if (turn) {
      const sphere = new THREE.Spherical().setFromVector3(offset), way = this.seated ? -0.08 : 0.1;
      sphere.theta += turn[0] * way;
      sphere.phi = Math.min(Math.max(sphere.phi + turn[1] * way, 0.05), Math.PI - 0.05);
      this.camera.position.copy(this.controls.target).add(offset.setFromSpherical(sphere));
      if (this.seated) {  // the head stays
        const target = this.controls.target.clone().sub(this.camera.position);
        this.camera.position.copy(this.seat.eye);
        this.controls.target.copy(this.seat.eye).add(target);
      }
      this.controls.update();
      this.moved();
    } else if (key === '+' || key === '-') this.zoomBy(key === '+' ? 1.18 : 1 / 1.18);
    else if (key === 'f') this.frameSelected();
    else if (key === 'o') this.frameAll();
    else if (key === 'home') this.goHome();
    else return;
    event.preventDefault();
  }

  /** The camera: more will follow soon. */
  moved() {
    this.pace.changing();
    this.invalidate();
  }

  detail(coarse) {
    for (const part of this.data.parts)
      for (const { geometry, data } of part.meshes)
        if (coarse) geometry.setDrawRange(data.indices.length, data.coarse.length);
        else geometry.setDrawRange(0, data.indices.length);
    this.resize();
    this.invalidate();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight || this.renderer.xr.isPresenting) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  invalidate() {
    if (this.pending || this.renderer.xr.isPresenting) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(); });
  }

  draw() {
    if (this.renderer.xr.isPresenting) return;
    this.pace.draw(() => this.paint());
  }

  paint() {
    this.marker.scale.setScalar(0.006 * this.marker.position.distanceTo(this.camera.position) / this.camera.zoom);
    this.beforeDraw?.();
    for (const mark of this.marks) mark.fit();  // of the same size on the screen wherever the camera is
    this.renderer.render(this.world, this.camera);
    Object.assign(this.canvas.dataset, {
      frames: Number(this.canvas.dataset.frames ?? 0) + 1,
      triangles: this.renderer.info.render.triangles, seat: this.seat?.kind ?? 'none', seated: this.seated,
      camera: this.camera.position.toArray().map((c) => c.toFixed(1)), look: this.camera.getWorldDirection(new THREE.Vector3()).toArray().map((c) => c.toFixed(3)),
    });
    this.onDrawn?.();
  }
}
