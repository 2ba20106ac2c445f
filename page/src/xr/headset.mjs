// SPDX-License-Identifier: MIT
// The scene in a headset at its true size.
import * as THREE from 'three';
import { VIEWS, reasonOff } from '../views.mjs';
import { Merged, fitTextures } from './budget.mjs';
import { Moving } from './moving.mjs';
import { Menu, NameTag } from './panel.mjs';
import { Tip } from './tip.mjs';

const $ = (id) => document.getElementById(id);
const METRE = 1e-3, SNAPSHOT = [640, 480];
const SHOWN_VIEWS = ['textured', 'checker', 'stretch', 'stiffness'];
const REMARKS = ['Please look at this', 'Seam is visible', 'Grain too large', 'Grain too small', 'Wrong colour', 'Feels too hard', 'Feels too soft', 'Feels too slippery'];
const STICK = 0.09;

export class Headset {
  constructor(page) {
    this.page = page;
    this.three = page.three;
    this.remark = 0;
    this.b = null;
  }

  /** Offers the button where the browser has a headset. */
  async offer() {
    const can = this.three && navigator.xr && await navigator.xr.isSessionSupported('immersive-vr').catch(() => false);
    $('enter-vr').hidden = !can;
    if (can) $('enter-vr').addEventListener('click', () => this.session ? this.session.end() : this.enter());
  }

  async enter() {
    const { three } = this, { xr } = three.renderer;
    try {
      const session = await navigator.xr.requestSession('immersive-vr', { optionalFeatures: ['local-floor', 'hand-tracking'] });
      session.addEventListener('end', () => this.leave());
      this.session = session;
      this.before = { position: three.camera.position.clone(), quaternion: three.camera.quaternion.clone(), zoom: three.camera.zoom };
      this.arrange();
      xr.enabled = true;
      xr.setReferenceSpaceType('local-floor');
      await xr.setSession(session);
      three.renderer.setAnimationLoop((time) => this.frame(time / 1000));
      $('enter-vr-text').textContent = 'Leave VR';
    } catch (error) {
      $('picked').textContent = `The headset can't be entered: ${error.message}`;
      this.session?.end();
    }
  }

  /** Metres in place of millimetres, one piece a material, hands. */
  arrange() {
    const { three, page } = this;
    this.textureBytes = fitTextures(three.standard);
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
    this.merged = new Merged(three, page.scene);
    this.merged.show(three, true);
    this.show(page.view);
    this.moving = new Moving(three, this.rig);
    this.hands = [0, 1].map((i) => this.hand(i));
    this.menu = new Menu(() => this.rows());
    this.tag = new NameTag();
    three.world.add(this.tag.mesh);
    this.caster = new THREE.Raycaster();
    three.outline.visible = false;
  }

  hand(i) {
    const { xr } = this.three.renderer, pointer = xr.getController(i), joints = xr.getHand(i);
    const hand = { pointer, joints, tip: new Tip(this.three, this.page.scene, this.page.compare), source: null };
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
    const materials = page.scene.materials.length;
    const cycle = (by) => () => { this.b = this.b === null ? (by > 0 ? 0 : materials - 1) : (this.b + by + materials) % materials; this.compare(); };
    return [
      SHOWN_VIEWS.slice(0, 2).map(button), SHOWN_VIEWS.slice(2).map(button),
      { text: `Part: ${this.spot ? page.nameOf(this.spot.use) : 'point and pull the trigger'}` },
      { text: this.b === null ? 'B: no second material' : `B: ${page.scene.materials[this.b].name || `material ${this.b}`}` },
      [{ text: '◂ B', run: cycle(-1) }, { text: 'B off', run: () => { this.b = null; this.compare(); } }, { text: 'B ▸', run: cycle(1) }],
      { text: `“${REMARKS[this.remark]}” ▸`, run: () => { this.remark = (this.remark + 1) % REMARKS.length; } },
      { text: `Take note and picture (${page.notes.list.length} taken)`, run: () => { this.wantsNote = Boolean(this.spot); } },
      [{ text: 'Sit', on: this.isSeated, run: () => this.sit() }, { text: 'Stand', on: !this.isSeated, run: () => this.stand() }],
      { text: 'Leave the headset', run: () => this.session.end() },
    ];
  }

  show(view) {
    const { page } = this;
    page.switchTo(view);
    this.merged.view(view, page.ranges.get(view.id));
  }

  compare() { if (this.spot) this.page.compareWith(this.b); }

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
    this.page.pick(hand.spot);
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
    three.compare?.fit();
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
    this.page.notes.add(this.spot, REMARKS[this.remark], eye, look, 'headset', this.picture());
    this.menu.draw();
  }

  /** What the head sees, as a JPEG in a data URL. */
  picture() {
    const { renderer, world, camera, scene } = this.three, [width, height] = SNAPSHOT, target = new THREE.WebGLRenderTarget(width, height, { colorSpace: THREE.SRGBColorSpace });
    const eye = new THREE.PerspectiveCamera(70, width / height, 0.02, 50), shown = renderer.getRenderTarget();
    camera.matrixWorld.decompose(eye.position, eye.quaternion, eye.scale);
    for (const { tip, ray } of this.hands) tip.ball.visible = ray.visible = false;
    this.three.outline.visible = this.tag.mesh.visible = false;
    scene.updateMatrixWorld();
    renderer.xr.enabled = false;
    renderer.setRenderTarget(target);
    renderer.render(world, eye);
    const bytes = new Uint8Array(4 * width * height), picture = new ImageData(width, height);
    renderer.readRenderTargetPixels(target, 0, 0, width, height, bytes);
    renderer.setRenderTarget(shown);
    renderer.xr.enabled = true;
    for (const { ray, source } of this.hands) ray.visible = source?.handedness === 'right';
    target.dispose();
    for (let y = 0; y < height; ++y) picture.data.set(bytes.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    for (let i = 3; i < picture.data.length; i += 4) picture.data[i] = 255;
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    canvas.getContext('2d').putImageData(picture, 0, 0);
    return canvas.toDataURL('image/jpeg', 0.8);
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
    this.merged.show(three, false);
    this.merged.dispose();
    three.world.remove(this.tag.mesh, this.rig);
    three.world.add(three.camera);
    three.scene.scale.setScalar(1);
    three.scene.traverse((o) => { if (o.isLOD) for (const level of o.levels) level.distance /= METRE; });
    Object.assign(this, { session: null, time: undefined, isSeated: undefined });
    three.camera.position.copy(this.before.position);
    three.camera.quaternion.copy(this.before.quaternion);
    three.camera.zoom = this.before.zoom;
    three.scene.updateMatrixWorld(true);
    three.camera.fov = three.fov;
    three.resize();
    three.settle();
    $('enter-vr-text').textContent = 'Enter VR';
  }
}
