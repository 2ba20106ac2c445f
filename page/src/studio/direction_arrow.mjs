// SPDX-License-Identifier: MIT
// The direction of the grain as an arrow on the selected surface, which one turns with the pointer or with , and . on the scene.
import * as THREE from 'three';
import { angleOf } from './direction.mjs';
import { listenFirst } from './first_listener.mjs';

/** Of the distance to the camera. */
const LENGTH = 0.16, WIDTH = 0.012, GRIP = 0.028, LIFT = 0.01;
const STEP = 5, FINE = 1;
const UP = new THREE.Vector3(0, 1, 0);

export class DirectionArrow {
  /** @param onTurn(degrees, isDone) while it is turned, and when that is done @param isWanted whether it is shown now */
  constructor(view, onTurn, isWanted) {
    Object.assign(this, { view, onTurn, isWanted, degrees: 0, anchor: null });
    const material = new THREE.MeshBasicMaterial({ color: 0xffb000, depthTest: false, transparent: true, toneMapped: false });
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(WIDTH / 2, WIDTH / 2, LENGTH, 10).translate(0, LENGTH / 2, 0), material);
    this.head = new THREE.Mesh(new THREE.ConeGeometry(GRIP / 2, GRIP, 16).translate(0, LENGTH, 0), material);
    this.ring = new THREE.Mesh(new THREE.TorusGeometry(LENGTH, WIDTH / 6, 6, 48).rotateX(Math.PI / 2), material);
    this.group = new THREE.Group();
    this.turned = new THREE.Group().add(this.shaft, this.head);
    this.group.add(this.turned, this.ring);
    this.group.traverse((o) => { o.renderOrder = 18; });
    this.group.visible = false;
    view.stage.add(this.group);
    view.marks.push(this);
    listenFirst(view.canvas, this);
  }

  /** @param anchor of anchorOf() in the part's coordinates, @param axes of axesAt(), @param use whose place in the scene it is */
  show(anchor, axes, use, degrees) {
    const place = new THREE.Matrix4().multiplyMatrices(this.view.root.matrixWorld, new THREE.Matrix4().set(...this.view.scene.uses[use].world));
    const turned = (v) => new THREE.Vector3(...v).transformDirection(place);
    this.anchor = { point: new THREE.Vector3(...anchor.point).applyMatrix4(place), normal: turned(anchor.normal), zero: turned(axes.zero), quarter: turned(axes.quarter) };
    this.set(degrees);
  }

  hide() {
    this.anchor = null;
    this.view.draw();
  }

  set(degrees) {
    this.degrees = degrees;
    if (!this.anchor) return;
    const { normal, zero, quarter } = this.anchor, a = degrees * Math.PI / 180;
    this.group.quaternion.setFromUnitVectors(UP, normal);
    const along = zero.clone().multiplyScalar(Math.cos(a)).addScaledVector(quarter, Math.sin(a)).applyQuaternion(this.group.quaternion.clone().invert());
    this.turned.quaternion.setFromUnitVectors(UP, along.normalize());
    this.view.draw();
  }

  /** Always of the same size on the screen; called before each picture. */
  fit() {
    this.group.visible = Boolean(this.anchor) && this.isWanted();
    if (!this.group.visible) return;
    const { camera } = this.view, far = camera.position.distanceTo(this.anchor.point) / camera.zoom;
    this.group.scale.setScalar(far);
    this.group.position.copy(this.anchor.point).addScaledVector(this.anchor.normal, LIFT * far);
    this.group.updateMatrixWorld(true);
  }

  ray({ clientX, clientY }) {
    const { left, top, width, height } = this.view.canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height), this.view.camera);
    return caster;
  }

  /** Whether the pointer is at the arrow's head. */
  isAt(event) {
    const tip = new THREE.Vector3(0, LENGTH, 0).applyMatrix4(this.turned.matrixWorld).project(this.view.camera), { left, top, width, height } = this.view.canvas.getBoundingClientRect();
    return Math.hypot(left + (tip.x + 1) / 2 * width - event.clientX, top + (1 - tip.y) / 2 * height - event.clientY) < 18;
  }

  down(event) {
    if (!this.group.visible || event.button !== 0 || !this.isAt(event)) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.view.canvas.setPointerCapture(event.pointerId);
    this.isHeld = true;
  }

  move(event) {
    if (!this.isHeld) return;
    event.stopImmediatePropagation();
    const { point, normal, zero, quarter } = this.anchor, plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, point);
    const at = this.ray(event).ray.intersectPlane(plane, new THREE.Vector3());
    if (!at) return;
    const way = at.sub(point).toArray();
    this.turn(angleOf(way, { zero: zero.toArray(), quarter: quarter.toArray() }), false);
  }

  up(event) {
    if (!this.isHeld) return;
    event.stopImmediatePropagation();
    this.isHeld = false;
    this.turn(this.degrees, true);
  }

  key(event) {
    const way = { ',': 1, '.': -1, '<': 1, '>': -1 }[event.key];
    if (!this.group.visible || !way || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    this.turn((this.degrees + way * (event.shiftKey ? FINE : STEP) + 360) % 360, true);
  }

  turn(degrees, isDone) {
    this.set(degrees);
    this.onTurn(degrees, isDone);
  }
}
