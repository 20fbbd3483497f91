// Renderer, cameras, light; draws when something has changed.
import * as THREE from 'three';
import { OrbitControls } from 'orbit';
import { light } from 'shaders';

THREE.ColorManagement.enabled = false;

/** Directions from which the scene is looked at; z points up. */
export const VIEWS = {
  oblique: [0.55, -1, 0.5], front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0],
  // Not quite along z, which stays upright: y points up in the picture.
  top: [0, -1e-4, 1], bottom: [0, -1e-4, -1],
};

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.scene = new THREE.Scene();
    this.cameras = {
      perspective: new THREE.PerspectiveCamera(35, 1, 0.01, 100),
      parallel: new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 100),
    };
    this.controls = {};
    for (const [name, camera] of Object.entries(this.cameras)) {
      camera.up.set(0, 0, 1);
      const controls = new OrbitControls(camera, canvas);
      controls.addEventListener('change', () => this.wanted());
      controls.addEventListener('start', () => { this.moved = true; });
      controls.zoomToCursor = true;
      controls.autoRotateSpeed = 4;
      this.controls[name] = controls;
    }
    this.projection = 'perspective';
    this.box = new THREE.Box3(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
    this.lamp = 'camera';
    this.before = this.after = this.resized = () => {};
    /** Whether the user has moved the camera since the last fit. */
    this.moved = false;
    /** Edges of the picture that are covered [CSS pixels], and half their difference. */
    this.margins = { left: 0, right: 0, top: 0, bottom: 0 };
    this.offset = [0, 0];
    this.frames = 0;
    this.select('perspective');
    new ResizeObserver(() => { this.resize(); this.resized(); }).observe(canvas.parentElement);
    this.resize();
  }

  get camera() { return this.cameras[this.projection]; }
  get control() { return this.controls[this.projection]; }

  /** Another projection, from the same side and at the same size. */
  select(projection) {
    const [from, to] = [this.camera, this.cameras[projection]];
    const target = this.control.target;
    if (projection !== this.projection) {
      const distance = from.position.distanceTo(target);
      const half = Math.tan((this.cameras.perspective.fov * Math.PI) / 360);
      to.up.copy(from.up);
      this.controls[projection].target.copy(target);
      to.position.copy(from.position);
      if (projection === 'parallel') {
        to.zoom = 1 / (distance * half);
      } else {
        to.position.sub(target).setLength(1 / (from.zoom * half)).add(target);
      }
    }
    this.projection = projection;
    for (const [name, controls] of Object.entries(this.controls)) controls.enabled = name === projection;
    this.resize();
    this.control.update();
  }

  /** What is to be seen. */
  setBox(box) { this.box.copy(box); }

  /** Fits a box between the margins, from a side. */
  look(view, box = this.box) {
    const centre = box.getCenter(new THREE.Vector3());
    const radius = 0.5 * this.box.getSize(new THREE.Vector3()).length() || 1;
    const direction = new THREE.Vector3(...VIEWS[view]).normalize();
    const { margins } = this;
    const wide = Math.max(this.width - margins.left - margins.right, 0.3 * this.width);
    const high = Math.max(this.height - margins.top - margins.bottom, 0.3 * this.height);
    this.offset = [0.5 * (margins.right - margins.left), 0.5 * (margins.bottom - margins.top)];
    const share = high / this.height;
    const half = share * Math.tan((this.cameras.perspective.fov * Math.PI) / 360);
    const right = new THREE.Vector3().crossVectors(direction, this.camera.up).normalize().negate();
    const above = new THREE.Vector3().crossVectors(right, direction).negate();
    // The corners of the box determine distance and centre: for each axis of the picture, the planes of its edges.
    const flat = this.projection === 'parallel';
    const target = centre.clone();
    let distance = 0;
    for (const [axis, slope] of [[right, (half * wide) / high], [above, half]]) {
      let [low, far] = [Infinity, -Infinity];
      for (let c = 0; c < 8; c++) {
        const corner = new THREE.Vector3(...[0, 1, 2].map((k) => (c >> k & 1 ? box.max : box.min).getComponent(k))).sub(centre);
        const [side, depth] = [corner.dot(axis), flat ? 0 : slope * corner.dot(direction)];
        [low, far] = [Math.min(low, side - depth), Math.max(far, side + depth)];
      }
      target.addScaledVector(axis, 0.5 * (low + far));
      distance = Math.max(distance, (0.53 * (far - low)) / slope);
    }
    this.control.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, flat ? 3 * radius : distance);
    if (flat) this.camera.zoom = 1 / (distance * half / share);
    this.shift();
    this.moved = false;
    this.control.update();
    this.wanted();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    [this.width, this.height] = [Math.max(clientWidth, 1), Math.max(clientHeight, 1)];
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(this.width, this.height);
    const aspect = this.width / this.height;
    this.cameras.perspective.aspect = aspect;
    const parallel = this.cameras.parallel;
    [parallel.left, parallel.right] = [-aspect, aspect];
    this.shift();
    this.draw();
  }

  /** Moves the centre of the picture to the middle between the margins; `pixel`: a pixel alone. */
  shift(pixel) {
    const [x, y] = this.offset;
    const part = pixel ? [x + pixel[0], y + pixel[1], 1, 1] : [x, y, this.width, this.height];
    Object.values(this.cameras).forEach((camera) => camera.setViewOffset(this.width, this.height, ...part));
  }

  /** Draws before the next picture of the screen. */
  wanted() {
    if (this.due) return;
    this.due = requestAnimationFrame(() => {
      this.due = 0;
      this.draw();
      if (this.control.autoRotate) {
        this.control.update(1 / 30);
        this.wanted();
      }
    });
  }

  /** Draws at once what is due. */
  now() {
    if (!this.due) return;
    cancelAnimationFrame(this.due);
    this.due = 0;
    this.draw();
    if (this.control.autoRotate) this.wanted();
  }

  /** Direction of sight. */
  sight() { return this.camera.getWorldDirection(new THREE.Vector3()); }

  /** Planes between which all is seen, and the lamp as the eye sees it. */
  prepare() {
    const camera = this.camera;
    camera.updateMatrixWorld();
    const centre = this.box.getCenter(new THREE.Vector3());
    const radius = 0.75 * this.box.getSize(new THREE.Vector3()).length() + 1e-6;
    const depth = centre.sub(camera.position).dot(this.sight());
    camera.far = Math.max(depth + 2 * radius, radius);
    camera.near = camera.isPerspectiveCamera ? Math.max(depth - 2 * radius, camera.far / 3000) : depth - 2 * radius;
    camera.updateProjectionMatrix();
    if (this.lamp === 'camera') {
      light.value.set(0.35, 0.5, 0.8).normalize();
    } else {
      light.value.set(...['x', 'y', 'z'].map((k) => (k === this.lamp ? 1 : 0)));
      light.value.transformDirection(camera.matrixWorldInverse);
    }
  }

  draw() {
    this.before();
    this.prepare();
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
    this.after();
  }
}
