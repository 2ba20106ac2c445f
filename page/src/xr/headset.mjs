// SPDX-License-Identifier: MIT
// The scene of a page in a headset at its true size.
import * as THREE from 'three';
import { VIEWS, reasonOff } from '../views.mjs';
import { Merged, fitTextures } from './budget.mjs';
import { Moving } from './moving.mjs';
import { Menu, NameTag } from './panel.mjs';
import { snapshot } from './snapshot.mjs';
import { XR } from './texts.mjs';
import { Tip } from './tip.mjs';

/**
 * What the headset asks of a page. Lengths in mm, Y up; a use is one place of a part, by its number.
 * @typedef {object} WornPage
 * @property {WornView} three
 * @property {{parts: {meshes: Mesh[]}[], materials: object[]}} scene materials as the pages' data have them, with their relief where it is there
 * @property {import('../compare.mjs').Compare} compare
 * @property {{list: object[], add: function}} notes add(spot, text, position, look, where, picture)
 * @property {object} view that is shown, of VIEWS
 * @property {number[]} range of its scale
 * @property {function(object)} switchTo shows a view
 * @property {function(number): string} nameOf a use
 * @property {?object} spot that was picked, @property {function(object)} pick picks one, of Surface
 * @property {{name: string, group: string}[]} choices of B; those of a group stand side by side
 * @property {?number} b its choice that the picked part has
 * @property {function(?number)} compareWith puts a choice there, or none
 * @property {function(string)} say
 * @property {function(boolean)} wear before the headset draws the scene, and after it has
 */
/**
 * @typedef {object} WornView
 * @property {THREE.WebGLRenderer} renderer
 * @property {THREE.PerspectiveCamera} camera
 * @property {HTMLCanvasElement} canvas
 * @property {THREE.Scene} world of metres while it is worn
 * @property {THREE.Group} scene in the world, of mm
 * @property {THREE.Group} root in the scene; its own children are drawn by material
 * @property {import('../surface.mjs').Surface} surface of meshes with {use, mesh} as userData
 * @property {THREE.Material[]} standard by number of the material, and `plain` where a mesh has none
 * @property {THREE.Object3D} outline of what is picked
 * @property {{fit: function}[]} marks told before each frame
 * @property {THREE.Box3} box of everything
 * @property {?{eye: THREE.Vector3, ahead: THREE.Vector3}} seat
 * @property {?function} onSurfaces set by the headset: called when other surfaces or materials are there
 */
/**
 * @typedef {object} Mesh
 * @property {number} material its number, @property {boolean} uv whether it has any, @property {number} vertices
 * @property {{positions, normals, uv, uv1, measured, indices, coarse}} data `coarse` indices may be empty
 */

const $ = (id) => document.getElementById(id);
const METRE = 1e-3;
const SHOWN_VIEWS = ['textured', 'checker', 'stretch', 'stiffness'];
const STICK = 0.09;

export class Headset {
  /** @param {WornPage} page */
  constructor(page) { Object.assign(this, { page, three: page.three, remark: 0 }); }

  /** Offers the button where the browser has a headset. */
  async offer() {
    const can = this.three && navigator.xr && await navigator.xr.isSessionSupported('immersive-vr').catch(() => false);
    $('enter-vr').hidden = !can;
    $('enter-vr-text').textContent = XR.enter;
    if (can) $('enter-vr').addEventListener('click', () => this.session ? this.session.end() : this.enter());
  }

  async enter() {
    const { three } = this, { xr } = three.renderer;
    try {
      const session = await navigator.xr.requestSession('immersive-vr', { optionalFeatures: ['local-floor', 'hand-tracking'] });
      session.addEventListener('end', () => setTimeout(() => this.leave()));  // when the renderer has left, too
      this.session = session;
      const { position, quaternion, zoom, fov, near, far } = three.camera;
      this.before = { position: position.clone(), quaternion: quaternion.clone(), lens: { zoom, fov, near, far } };
      this.page.wear(true);
      this.arrange();
      xr.enabled = true;
      xr.setReferenceSpaceType('local-floor');
      await xr.setSession(session);
      three.renderer.setAnimationLoop((time) => this.frame(time / 1000));
      $('enter-vr-text').textContent = XR.leaveVr;
    } catch (error) {
      this.page.say(XR.failed(error.message));
      this.session?.end();
    }
  }

  /** Metres in place of millimetres, one piece a material, hands. */
  arrange() {
    const { three, page } = this;
    three.scene.scale.setScalar(METRE);
    three.scene.traverse((o) => { if (o.isLOD) for (const level of o.levels) level.distance *= METRE; });
    this.rig = new THREE.Group();
    three.world.add(this.rig);
    this.rig.add(three.camera);
    three.camera.near = 0.02;
    three.camera.far = 50;
    three.camera.zoom = 1;
    three.camera.position.set(0, 0, 0);  // of the rig, until the headset says where it is
    three.camera.quaternion.identity();
    this.merged = new Merged(three, page);
    this.merged.show(true);
    this.showSurfaces();
    three.onSurfaces = () => this.showSurfaces();
    this.moving = new Moving(three, this.rig);
    this.hands = [0, 1].map((i) => this.hand(i));
    this.menu = new Menu(() => this.rows());
    this.tag = new NameTag();
    three.world.add(this.tag.mesh);
    this.caster = new THREE.Raycaster();
  }

  hand(i) {
    const { xr } = this.three.renderer, pointer = xr.getController(i), joints = xr.getHand(i);
    const hand = { pointer, joints, tip: new Tip(this.three, this.page.compare), source: null };
    const stick = new THREE.Mesh(new THREE.CylinderGeometry(0.0015, 0.006, STICK, 12).rotateX(-Math.PI / 2).translate(0, 0, STICK / 2), new THREE.MeshStandardMaterial({ color: 0x9aa3ad, roughness: 0.5 }));
    const ray = new THREE.Line(new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, -1)]), new THREE.LineBasicMaterial({ color: 0x7cb8ff, toneMapped: false }));
    hand.ray = ray;
    pointer.add(stick, ray);
    hand.heard = {
      connected: ({ data }) => {
        hand.source = data;
        if (data.handedness === 'left') pointer.add(this.menu.mesh);
        ray.visible = data.handedness !== 'left';
        stick.visible = !data.hand;
      },
      disconnected: () => { hand.source = null; },
      selectstart: () => this.select(hand),
    };
    for (const [event, listener] of Object.entries(hand.heard)) pointer.addEventListener(event, listener);
    this.rig.add(pointer, joints);
    hand.tip.sound.start();
    return hand;
  }

  rows() {
    const { page } = this, view = (id) => VIEWS.find((v) => v.id === id);
    const button = (id) => ({ text: id, on: page.view.id === id, run: reasonOff(view(id), page.scene) ? null : () => this.show(view(id)) });
    const { choices, b } = page, chosen = b === null ? null : choices[b], groups = [...new Set(choices.map(({ group }) => group))];
    return [
      SHOWN_VIEWS.slice(0, 2).map(button), SHOWN_VIEWS.slice(2).map(button),
      { text: XR.part(this.spot && page.nameOf(this.spot.use)) },
      { text: chosen ? XR.second(chosen.name) : XR.noSecond },
      ...groups.length > 1 ? [[{ text: XR.groupBefore, run: () => this.chooseGroup(groups, -1) }, { text: chosen?.group ?? groups[0] }, { text: XR.groupAfter, run: () => this.chooseGroup(groups, 1) }]] : [],
      [{ text: XR.before, run: () => this.choose(-1) }, { text: XR.off, run: () => this.compareWith(null) }, { text: XR.after, run: () => this.choose(1) }],
      { text: XR.remark(XR.remarks[this.remark]), run: () => { this.remark = (this.remark + 1) % XR.remarks.length; } },
      { text: XR.note(page.notes.list.length), run: () => { this.wantsNote = Boolean(this.spot); } },
      [{ text: XR.sit, on: this.isSeated, run: () => this.sit() }, { text: XR.stand, on: !this.isSeated, run: () => this.stand() }],
      { text: XR.leave, run: () => this.session.end() },
    ];
  }

  /** The next B, or the one before. */
  choose(by) {
    const { choices: { length }, b } = this.page;
    if (length) this.compareWith(b === null ? (by > 0 ? 0 : length - 1) : (b + by + length) % length);
  }

  /** The first B of the next group, or of the one before. */
  chooseGroup(groups, by) {
    const { page } = this, now = groups.indexOf(page.choices[page.b ?? 0].group), next = groups[(now + by + groups.length) % groups.length];
    this.compareWith(page.choices.findIndex(({ group }) => group === next));
  }

  /** B on the part that the menu names: it may have been touched, not picked. */
  compareWith(b) {
    const { page, spot } = this;
    if (spot && spot.use !== page.spot?.use) page.pick(spot);
    page.compareWith(b);
  }

  show(view) {
    const { page } = this;
    page.switchTo(view);
    this.merged.view(view, page.range);
  }

  /** The surfaces that are there now. */
  showSurfaces() {
    this.textureBytes = fitTextures(this.three.standard);
    this.merged.update();
    this.show(this.page.view);
  }

  sit() {
    this.isSeated = true;
    this.moving.sit(this.three.seat ?? { eye: this.three.box.getCenter(new THREE.Vector3()).setY(this.three.box.min.y + 1600), ahead: new THREE.Vector3(0, 0, -1) });
  }

  stand() {
    this.isSeated = false;
    this.moving.stand();
  }

  /** The trigger: the menu, or the part that is pointed at. */
  select(hand) {
    if (hand.source?.handedness === 'left' || this.menu.press()) return;
    if (!hand.spot) return;
    this.spot = hand.spot;
    const { b } = this.page;
    this.page.pick(hand.spot);
    if (b !== null) this.page.compareWith(b);  // comes along
    this.menu.draw();
  }

  frame(time) {
    const { three } = this, seconds = Math.min(time - (this.time ?? time), 0.1);
    this.time = time;
    const head = three.camera.getWorldPosition(new THREE.Vector3());
    if (this.isSeated === undefined && three.camera.position.lengthSq() > 0) three.seat ? this.sit() : this.stand();
    const axes = { left: { x: 0, y: 0 }, right: { x: 0, y: 0 } };
    for (const hand of this.hands) {
      const stick = hand.source?.gamepad?.axes;
      if (stick && axes[hand.source.handedness]) axes[hand.source.handedness] = { x: stick[2] ?? 0, y: stick[3] ?? 0 };
      this.point(hand, head);
      this.touch(hand, time);
    }
    this.moving.move(axes.left, axes.right, this.caster.ray, seconds);
    for (const mark of three.marks) mark.fit();
    three.renderer.render(three.world, three.camera);
    const { calls, triangles } = three.renderer.info.render;
    Object.assign(three.canvas.dataset, { xrFrames: Number(three.canvas.dataset.xrFrames ?? 0) + 1, xrCalls: calls, xrTriangles: triangles, xrTextureBytes: this.textureBytes });
    if (this.wantsNote) this.takeNote(head);
  }

  /** What the right pointer is at: the menu, else a part, whose name is shown. */
  point(hand, head) {
    if (!hand.source || hand.source.handedness === 'left') return;
    hand.pointer.updateWorldMatrix(true, false);
    this.caster.ray.origin.setFromMatrixPosition(hand.pointer.matrixWorld);
    this.caster.ray.direction.set(0, 0, -1).transformDirection(hand.pointer.matrixWorld);
    const onMenu = this.menu.mesh.parent ? this.menu.point(this.caster) : null;
    const { origin, direction } = this.caster.ray;
    hand.spot = onMenu === null ? this.three.surface.meet(origin.clone().divideScalar(METRE), direction) : null;
    hand.ray.scale.z = onMenu ?? (hand.spot ? hand.spot.distance * METRE : 3);
    if (hand.spot) this.tag.show(this.page.nameOf(hand.spot.use), hand.spot.point.clone().multiplyScalar(METRE), head);
    else this.tag.hide();
  }

  touch(hand, time) {
    const finger = hand.source?.hand ? hand.joints.joints['index-finger-tip'] : null, end = finger ?? hand.pointer;
    if (!hand.source || !end.visible) return void hand.tip.lift();
    end.updateWorldMatrix(true, false);
    const point = new THREE.Vector3().setFromMatrixPosition(end.matrixWorld).divideScalar(METRE);
    const contact = hand.tip.touch(point, time, finger ? null : hand.source.gamepad?.hapticActuators?.[0]);
    if (contact) this.spot = contact.spot;
    this.three.canvas.dataset[`xrContact${hand.source.handedness}`] = contact ? JSON.stringify({ part: this.page.nameOf(contact.spot.use), normal: contact.normal, friction: contact.friction, strength: contact.strength, speed: contact.speed, depth: contact.spot.depth }) : '';
  }

  takeNote(head) {
    this.wantsNote = false;
    const eye = head.clone().divideScalar(METRE), look = this.three.camera.getWorldDirection(new THREE.Vector3());
    this.page.notes.add(this.spot, XR.remarks[this.remark], eye, look, 'headset', this.picture());
    this.menu.draw();
  }

  /** What the head sees of the scene, as a JPEG in a data URL. */
  picture() {
    for (const { tip, ray } of this.hands) tip.ball.visible = ray.visible = false;
    this.three.outline.visible = this.tag.mesh.visible = false;
    const picture = snapshot(this.three);
    for (const { ray, source } of this.hands) ray.visible = source?.handedness === 'right';
    return picture;
  }

  /** The page as it was. */
  leave() {
    const { three } = this;
    three.renderer.setAnimationLoop(null);
    three.renderer.xr.enabled = false;
    for (const hand of this.hands) {
      hand.tip.end();
      hand.pointer.clear();
      for (const [event, listener] of Object.entries(hand.heard)) hand.pointer.removeEventListener(event, listener);
    }
    this.moving.end();
    three.onSurfaces = null;
    this.merged.show(false);
    this.merged.dispose();
    three.world.remove(this.tag.mesh, this.rig);
    three.world.add(three.camera);
    three.scene.scale.setScalar(1);
    three.scene.traverse((o) => { if (o.isLOD) for (const level of o.levels) level.distance /= METRE; });
    Object.assign(this, { session: null, time: undefined, isSeated: undefined });
    three.camera.position.copy(this.before.position);
    three.camera.quaternion.copy(this.before.quaternion);
    Object.assign(three.camera, this.before.lens);
    three.camera.updateProjectionMatrix();
    three.scene.updateMatrixWorld(true);
    this.page.wear(false);
    $('enter-vr-text').textContent = XR.enter;
  }
}
