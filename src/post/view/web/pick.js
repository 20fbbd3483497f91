// What lies below a point of the picture: the scene is drawn once more, into one pixel, with numbers in place of colours.
import * as THREE from 'three';

export class Picker {
  constructor(stage) {
    this.stage = stage;
    this.target = new THREE.WebGLRenderTarget(1, 1);
    this.pixel = new Uint8Array(4);
  }

  /** `meshes`: [mesh, number of its kind]; others are hidden. Returns { kind, index } or null. */
  at(x, y, meshes) {
    const { renderer, scene, camera } = this.stage;
    const hidden = [];
    const materials = new Map(meshes.map(([mesh, kind]) => [mesh, kind]));
    scene.traverse((object) => {
      if (!(object.isMesh || object.isLineSegments) || !object.visible || materials.has(object)) return;
      object.visible = false;
      hidden.push(object);
    });
    const was = meshes.map(([mesh]) => mesh.material.transparent);
    meshes.forEach(([mesh, kind]) => {
      mesh.material.uniforms.picking.value = 1;
      mesh.material.uniforms.pickKind.value = kind;
      mesh.material.blending = THREE.NoBlending;
    });
    const background = scene.background;
    scene.background = null;
    const clear = [renderer.getClearColor(new THREE.Color()), renderer.getClearAlpha()];
    renderer.setClearColor(0x000000, 0);
    this.stage.shift([x, y]);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, this.pixel);
    renderer.setRenderTarget(null);
    this.stage.shift();
    renderer.setClearColor(...clear);
    scene.background = background;
    meshes.forEach(([mesh], k) => {
      mesh.material.uniforms.picking.value = 0;
      mesh.material.blending = THREE.NormalBlending;
      mesh.material.transparent = was[k];
    });
    hidden.forEach((object) => { object.visible = true; });
    const [low, mid, high, kind] = this.pixel;
    return kind ? { kind, index: low + 256 * mid + 65536 * high } : null;
  }

  /** Place in the picture [pixels] of a point. */
  project(point) {
    const { camera, width, height } = this.stage;
    const p = new THREE.Vector3(...point).project(camera);
    return [(p.x + 1) * 0.5 * width, (1 - p.y) * 0.5 * height];
  }
}
