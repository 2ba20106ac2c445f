// SPDX-License-Identifier: MIT
// The scene in 3D: drawn only when something changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { bytesOf } from './data.mjs';
import { applyView, shadingOf, sideOf, uvMatrix } from './shading.mjs';

const GL_WRAP = { 33071: THREE.ClampToEdgeWrapping, 33648: THREE.MirroredRepeatWrapping };

/** A full frame that takes longer makes moving unpleasant. */
const SLOW_MS = 30, MOVING_MS = 60;
const REST_MS = 250, LONGEST_REST_MS = 3000;

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

/** An equirectangular picture of linear light, coded as RGBE, rows from the top. */
function environmentTexture({ width, height, rgbe }) {
  const bytes = bytesOf(rgbe), half = new Uint16Array(4 * width * height), one = THREE.DataUtils.toHalfFloat(1), most = 65504;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const from = 4 * (width * y + x), to = 4 * (width * (height - 1 - y) + x), scale = 2 ** (bytes[from + 3] - 136);
      for (let k = 0; k < 3; ++k) half[to + k] = THREE.DataUtils.toHalfFloat(Math.min(bytes[from + k] * scale, most));
      half[to + 3] = one;
    }
  const texture = new THREE.DataTexture(half, width, height, THREE.RGBAFormat, THREE.HalfFloatType, THREE.EquirectangularReflectionMapping,
    THREE.RepeatWrapping, THREE.ClampToEdgeWrapping, THREE.LinearFilter, THREE.LinearFilter);
  texture.needsUpdate = true;
  return texture;
}

async function textureOf(scene, reference, isColour) {
  const image = reference && scene.images[reference.image];
  if (!image) return null;
  const bitmap = await createImageBitmap(new Blob([bytesOf(image.bytes)], { type: image.type }), { colorSpaceConversion: 'none' })
    .catch(() => null);  // A format that this browser does not know, or a damaged picture: drawn without it.
  if (!bitmap) return null;
  return placed(new THREE.Texture(bitmap), reference, isColour);
}

function placed(texture, reference, isColour) {
  texture.flipY = false;
  texture.colorSpace = isColour ? THREE.SRGBColorSpace : THREE.NoColorSpace;
  [texture.wrapS, texture.wrapT] = reference.wrap.map((w) => GL_WRAP[w] ?? THREE.RepeatWrapping);
  texture.anisotropy = 4;
  texture.channel = reference.tex_coord;
  texture.matrixAutoUpdate = false;
  texture.matrix.copy(uvMatrix(reference));
  texture.needsUpdate = true;
  return texture;
}

/** Pixels as a texture at a reference's place: `before` with new ones, where it has their size. */
function pixelTexture(before, pixels, { width, height }, reference, isColour) {
  if (!pixels) return before?.dispose() ?? null;
  if (before?.isDataTexture && before.image.width === width && before.image.height === height) {
    before.image.data = pixels;
    before.needsUpdate = true;
    return before;
  }
  before?.dispose();
  const texture = placed(new THREE.DataTexture(pixels, width, height), reference, isColour);
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  return texture;
}

function standardMaterial(material) {
  if (!material) return new THREE.MeshStandardMaterial({ color: 0x9aa3ad, roughness: 0.8, side: sideOf(material) });
  const [r, g, b, a] = material.color;
  const blend = material.alpha_mode === 'BLEND';
  const common = {
    color: new THREE.Color(r, g, b), side: sideOf(material), transparent: blend, opacity: blend ? a : 1,
    depthWrite: !blend, alphaTest: material.alpha_mode === 'MASK' ? material.alpha_cutoff : 0,
  };
  if (material.unlit) return new THREE.MeshBasicMaterial({ ...common, toneMapped: false });
  return new THREE.MeshStandardMaterial({
    ...common, roughness: material.roughness, metalness: material.metallic, emissive: new THREE.Color(...material.emissive),
  });
}

export class SceneView {
  /** @param onPick called with {use, mesh, face, point, bary} */
  constructor(canvas, scene, onPick, onHover) {
    Object.assign(this, { canvas, data: scene, onPick, onHover, fullMs: 0 });
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.ratio = Math.min(window.devicePixelRatio, 2);
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.toneMapping = THREE.ACESFilmicToneMapping;
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.1, 1e6);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.moved());
    this.addMeshes();
    this.addLights();
    this.addMarker();
    this.frameAll();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
    this.loaded = this.loadTextures().catch((error) => { this.textureError = error.message; });
  }

  /** The scene's environment, or a plain room and a sun, and those that materials have of their own. */
  addLights() {
    const generator = new THREE.PMREMGenerator(this.renderer);
    const lights = this.data.environments.map((picture) => generator.fromEquirectangular(environmentTexture(picture)).texture);
    this.data.materials.forEach(({ environment, unlit }, i) => { if (environment !== null && !unlit) this.standard[i].envMap = lights[environment]; });
    this.world.add(this.camera);
    if (this.data.environment !== null) {
      this.world.environment = lights[this.data.environment];
      return;
    }
    this.world.environment = generator.fromScene(new RoomEnvironment(), 0.04, 0.1, 100, { size: 64 }).texture;
    const sun = new THREE.DirectionalLight(0xffffff, 1.5);
    sun.position.set(0.4, 0.5, 1);
    this.camera.add(sun);
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
    this.world.add(this.root);
    this.root.updateMatrixWorld(true);
    this.box = new THREE.Box3().setFromObject(this.root);
    if (this.box.isEmpty()) this.box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
    this.size = this.box.getSize(new THREE.Vector3()).length();
  }

  /** Levels of detail by the share of the picture's height that the sphere around the finest one takes. */
  addLevels(coverages, groups) {
    if (!groups[0]) return;
    const { center, radius } = new THREE.Box3().setFromObject(groups[0]).getBoundingSphere(new THREE.Sphere());
    const lod = new THREE.LOD(), distance = (coverage) => radius / (coverage * Math.tan(this.camera.fov * Math.PI / 360));
    lod.position.copy(center);
    for (let k = 0; k <= coverages.length; ++k) {
      const group = groups[k] ?? new THREE.Group();  // Below the last coverage there is nothing.
      group.position.copy(center).negate();
      const from = k === 0 ? 0 : distance(coverages[k - 1]);
      if (Number.isFinite(from)) lod.addLevel(group, from);
    }
    this.root.add(lod);
  }

  addMarker() {
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(this.size / 250, 16, 12), new THREE.MeshBasicMaterial({ color: 0xff3030, depthTest: false }));
    this.marker.renderOrder = 10;
    this.marker.visible = false;
    this.outline = new THREE.Box3Helper(new THREE.Box3(), 0xff8c00);
    this.outline.visible = false;
    this.world.add(this.marker, this.outline);
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
        if (material.normal_map) standard.normalScale.setScalar(material.normal_map.factor);
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
    for (const object of this.meshes) if (object.userData.use === use) box.expandByObject(object);
    this.outline.visible = !box.isEmpty();
    if (box.isEmpty()) return;
    this.outline.box.copy(box);
    this.selected = box;
    if (frame) this.frame(box, 1.25);
    this.invalidate();
  }

  mark(use, mesh, local) {
    const object = this.meshes.find((o) => o.userData.use === use && o.userData.mesh === mesh);
    this.marker.position.copy(local).applyMatrix4(object.matrixWorld);
    this.marker.visible = true;
    this.invalidate();
  }

  frameAll() {
    this.camera.position.copy(new THREE.Vector3(0.7, 0.55, 0.9));
    this.resize();
    this.frame(this.box, 1.03);
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
    const centre = box.getCenter(new THREE.Vector3()), direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, margin * this.distanceTo(box, direction));
    this.camera.near = this.size / 2000;
    this.camera.far = this.size * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.invalidate();
  }

  hitAt(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((event.clientX - left) / width * 2 - 1, 1 - (event.clientY - top) / height * 2), this.camera);
    const [hit] = ray.intersectObjects(this.meshes.filter(({ parent }) => parent.visible), false);
    if (!hit) return null;
    const { use, mesh } = hit.object.userData;
    return { use, mesh, face: hit.faceIndex, local: hit.object.worldToLocal(hit.point.clone()), uv: hit.uv, bary: hit.barycoord };
  }

  listen() {
    let down = null, waiting = false;
    this.canvas.addEventListener('pointerdown', (e) => { down = e; });
    this.canvas.addEventListener('pointerup', (e) => {
      if (down && Math.hypot(e.clientX - down.clientX, e.clientY - down.clientY) < 4) this.onPick(this.hitAt(e));
      down = null;
    });
    this.canvas.addEventListener('pointermove', (e) => {
      if (e.buttons || waiting) return;
      waiting = true;
      requestAnimationFrame(() => { waiting = false; this.onHover(this.hitAt(e)); });
    });
    this.canvas.addEventListener('keydown', (e) => this.onKey(e));
  }

  onKey(event) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const offset = this.camera.position.clone().sub(this.controls.target);
    const sphere = new THREE.Spherical().setFromVector3(offset);
    if (turn) {
      sphere.theta += turn[0] * 0.1;
      sphere.phi = Math.min(Math.max(sphere.phi + turn[1] * 0.1, 0.05), Math.PI - 0.05);
    } else if (event.key === '+' || event.key === '-') sphere.radius *= event.key === '+' ? 0.85 : 1.18;
    else if (event.key === 'f' || event.key === 'F') return this.frame(this.selected ?? this.box, 1.25);
    else if (event.key === 'Home') return this.frameAll();
    else return;
    event.preventDefault();
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3().setFromSpherical(sphere));
    this.controls.update();
    this.moved();
  }

  /** While the camera moves, a slow machine draws the coarse triangles in half the resolution, down to a quarter where a
   * full frame takes a second; the longer that is, the longer it waits for the next move before it begins one. */
  moved() {
    if (this.slow) this.detail(true);
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.detail(false), Math.min(Math.max(REST_MS, this.fullMs / 2), LONGEST_REST_MS));
    this.invalidate();
  }

  detail(coarse) {
    if (this.coarse === coarse) return;
    this.coarse = coarse;
    for (const part of this.data.parts)
      for (const { geometry, data } of part.meshes)
        if (coarse) geometry.setDrawRange(data.indices.length, data.coarse.length);
        else geometry.setDrawRange(0, data.indices.length);
    const divisor = Math.min(Math.max(Math.sqrt(this.fullMs / MOVING_MS), 2), 4);
    this.renderer.setPixelRatio(coarse ? this.ratio / divisor : this.ratio);
    this.resize();
    this.invalidate();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  invalidate() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(); });
  }

  draw() {
    const start = performance.now();
    this.beforeDraw?.();
    this.renderer.render(this.world, this.camera);
    this.frames = (this.frames ?? 0) + 1;
    this.canvas.dataset.frames = this.frames;
    this.canvas.dataset.triangles = this.renderer.info.render.triangles;
    this.onDrawn?.();
    if (this.frames < 3 || this.coarse) return;
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));  // waits until the frame is there
    this.fullMs = performance.now() - start;
    this.slow = this.fullMs > SLOW_MS;
  }
}
