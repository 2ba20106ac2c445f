// SPDX-License-Identifier: MIT
// The texture coordinates of the selected part, drawn with the shading of the scene, edges on top.
import * as THREE from 'three';
import { applyView, shadingOf } from './shading.mjs';

/** The triangle of the mesh that covers (u, v), with barycentric coordinates; null when there is none. */
export function triangleAt({ uv, indices }, u, v) {
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [indices[t], indices[t + 1], indices[t + 2]];
    const ax = uv[2 * a], ay = uv[2 * a + 1], bx = uv[2 * b] - ax, by = uv[2 * b + 1] - ay, cx = uv[2 * c] - ax, cy = uv[2 * c + 1] - ay;
    const area = bx * cy - by * cx;
    if (area === 0) continue;
    const s = ((u - ax) * cy - (v - ay) * cx) / area, r = (bx * (v - ay) - by * (u - ax)) / area;
    if (s >= 0 && r >= 0 && s + r <= 1) return { face: t / 3, bary: [1 - s - r, s, r] };
  }
  return null;
}

export class UvView {
  constructor(canvas, scene, onPick) {
    Object.assign(this, { canvas, data: scene, onPick, zoom: 1 });
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.world = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
    this.group = new THREE.Group();
    this.marker = new THREE.Mesh(new THREE.RingGeometry(0.7, 1, 24), new THREE.MeshBasicMaterial({ color: 0xff3030, depthTest: false }));
    this.marker.renderOrder = 10;
    this.marker.visible = false;
    this.edges = new THREE.LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.25 });
    this.borders = new THREE.LineBasicMaterial({ color: 0xff8c00 });
    this.world.add(this.group, this.marker);
    new ResizeObserver(() => this.fit()).observe(canvas);
    canvas.addEventListener('click', (e) => this.pick(e));
    canvas.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    canvas.addEventListener('keydown', (e) => this.key(e));
  }

  setBackground(colour) { this.world.background = new THREE.Color(colour); this.draw(); }

  show(use) {
    this.use = use;
    this.meshes = this.data.parts[this.data.instances[use].part].meshes.filter((mesh) => mesh.uv);
    this.group.clear();
    this.marker.visible = false;
    this.box = new THREE.Box2();
    for (const mesh of this.meshes) {
      mesh.flatShader ??= shadingOf(this.data.materials[mesh.material], mesh, true);
      const object = new THREE.Mesh(mesh.geometry, mesh.flatShader);
      object.frustumCulled = false;
      this.group.add(object, this.lines(mesh));
      this.box.expandByPoint(new THREE.Vector2(mesh.uv_low[0], -mesh.uv_high[1])).expandByPoint(new THREE.Vector2(mesh.uv_high[0], -mesh.uv_low[1]));
    }
    this.zoom = 1;
    this.centre = this.box.isEmpty() ? new THREE.Vector2() : this.box.getCenter(new THREE.Vector2());
    if (this.view) this.setView(this.view, this.range);
    this.fit();
  }

  /** Edges with one triangle: borders and seams. */
  lines(mesh) {
    if (!mesh.uvLines) {
      const { indices, uv } = mesh.data, once = new Map();
      for (let t = 0; t < indices.length; t += 3)
        for (let k = 0; k < 3; ++k) {
          const a = indices[t + k], b = indices[t + (k + 1) % 3], key = a < b ? a * 4294967296 + b : b * 4294967296 + a;
          once.set(key, once.has(key) ? null : [a, b]);
        }
      const points = [];
      for (const edge of once.values()) if (edge) for (const i of edge) points.push(uv[2 * i], -uv[2 * i + 1], 0);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
      mesh.uvLines = new THREE.LineSegments(geometry, this.borders);
      mesh.uvLines.frustumCulled = false;
    }
    return mesh.uvLines;
  }

  setView(view, range) {
    Object.assign(this, { view, range });
    for (const mesh of this.meshes ?? []) applyView(mesh.flatShader, view, range, this.data.materials[mesh.material]);
    this.draw();
  }

  mark(u, v) {
    this.marker.position.set(u, -v, 0);
    this.marker.visible = true;
    this.draw();
  }

  place(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect(), c = this.camera;
    return [c.left + (c.right - c.left) * (event.clientX - left) / width, -(c.top + (c.bottom - c.top) * (event.clientY - top) / height)];
  }

  pick(event) {
    const [u, v] = this.place(event);
    for (const mesh of this.meshes ?? []) {
      const hit = triangleAt(mesh.data, u, v);
      if (hit) return this.onPick({ use: this.use, mesh, ...hit, uv: { x: u, y: v } });
    }
  }

  zoomBy(factor, about) {
    const before = about ?? [this.centre.x, -this.centre.y];
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.5), 200);
    this.centre.set(before[0] + (this.centre.x - before[0]) / factor, -before[1] + (this.centre.y + before[1]) / factor);
    this.fit();
  }

  wheel(event) {
    if (!this.meshes?.length) return;
    event.preventDefault();
    this.zoomBy(event.deltaY < 0 ? 1.2 : 1 / 1.2, this.place(event));
  }

  key(event) {
    const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!this.meshes?.length) return;
    if (event.key === '+' || event.key === '-') this.zoomBy(event.key === '+' ? 1.2 : 1 / 1.2);
    else if (move) {
      this.centre.x += move[0] * 0.1 * (this.camera.right - this.camera.left);
      this.centre.y += move[1] * 0.1 * (this.camera.top - this.camera.bottom);
      this.fit();
    } else return;
    event.preventDefault();
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    const size = this.box && !this.box.isEmpty() ? this.box.getSize(new THREE.Vector2()) : new THREE.Vector2(1, 1);
    const half = 0.53 * Math.max(size.x / width, size.y / height, 1e-9) / this.zoom;
    const { x, y } = this.centre ?? { x: 0, y: 0 };
    Object.assign(this.camera, { left: x - half * width, right: x + half * width, top: y + half * height, bottom: y - half * height });
    this.camera.updateProjectionMatrix();
    this.marker.scale.setScalar(8 * half);
    this.draw();
  }

  draw() { this.renderer.render(this.world, this.camera); }
}
