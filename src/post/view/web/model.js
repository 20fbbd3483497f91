// Objects of a scene before it runs: surfaces, lines and spheres by kind.
import * as THREE from 'three';
import { rgb } from 'colours';
import { lineMaterial, surfaceMaterial } from 'shaders';
import { spread } from 'solid';
import { Spheres } from 'spheres';

/** Numbers from which objects are numbered in pictures for picking, and how many can be. */
const [FIRST, MOST] = [10, 240];
/** Surfaces with more triangles have no edges, unless they are of the solid. */
const EDGES = 3000;

export class Model {
  constructor() {
    this.group = new THREE.Group();
    this.items = [];
    this.kinds = [];
  }

  /** Frees what the graphics processor holds: a scene is read again whenever it is saved. */
  dispose() {
    this.group.traverse(({ geometry, material }) => { geometry?.dispose(); material?.dispose(); });
  }

  /** Takes objects and their geometry. */
  take({ kinds, items }, { arrays }) {
    this.kinds = kinds;
    this.items = items.map((item, k) => {
      const own = (name) => arrays[`${name}/${k}`];
      return { ...item, id: `${kinds[item.kind].word}/${item.name}`, ...this.objects(item, own, kinds[item.kind]) };
    });
  }

  objects(item, own, { word, opacity }) {
    const [points, triangles, edges, balls, ids] = ['points', 'triangles', 'edges', 'spheres', 'ids'].map(own);
    const made = { points, triangles, balls, ids, meshes: [], materials: [] };
    const glass = opacity < 1;
    const add = (object, material, order) => {
      object.frustumCulled = false;
      object.renderOrder = order + (glass ? 22 : 0);
      made.materials.push(material);
      this.group.add(object);
      made.meshes.push(object);
      return object;
    };
    const tint = (material) => material.uniforms.tint.value.set(...rgb(item.colour));
    if (triangles.length) {
      const material = surfaceMaterial();
      tint(material);
      material.uniforms.opacity.value = opacity;
      Object.assign(material, { transparent: glass, depthWrite: !glass });
      // Marks lie on surfaces of the solid.
      if (word !== 'solid') Object.assign(material, { polygonOffsetFactor: -1, polygonOffsetUnits: -1 });
      made.surface = add(new THREE.Mesh(spread(points, triangles), material), material, 0);
    }
    if (edges.length && (!triangles.length || word === 'solid' || triangles.length < 3 * EDGES)) {
      const material = triangles.length ? lineMaterial([0.08, 0.1, 0.14], 0.35) : lineMaterial([0, 0, 0], 1);
      if (!triangles.length) tint(material);
      add(new THREE.LineSegments(spread(points, edges), material), material, 8);
    }
    if (balls.length) {
      const spheres = new Spheres();
      spheres.reserve(balls.length / 4);
      spheres.places.set(balls);
      spheres.moved();
      tint(spheres.material);
      this.group.add(spheres.group);
      made.meshes.push(spheres.group);
      made.spheres = spheres;
    }
    return made;
  }

  shows(item, { kinds, hidden }) {
    const { word, shown } = this.kinds[item.kind];
    return (kinds[word] ?? shown) && !hidden[item.id];
  }

  /** `look`: kinds and objects that are shown. */
  look(look) {
    this.items.forEach((item) => {
      const shown = this.shows(item, look);
      item.meshes.forEach((mesh) => { mesh.visible = shown; });
    });
    this.seen = look;
  }

  /** Leaves out what lies beyond the ends along an axis; returns how many spheres. */
  section(axis, low, high) {
    let removed = 0;
    for (const { materials, spheres, balls } of this.items) {
      for (const material of materials) {
        material.uniforms.cut.value.set(...axis);
        material.uniforms.ends.value.set(low, high);
      }
      if (!spheres) continue;
      for (let k = 0; k < balls.length; k += 4) {
        const d = balls[k] * axis[0] + balls[k + 1] * axis[1] + balls[k + 2] * axis[2];
        const gone = d < low || d > high;
        removed += gone;
        spheres.places[k + 3] = gone ? 0 : balls[k + 3];
      }
      spheres.moved();
    }
    return removed;
  }

  /** Box of an object, with some room around it. */
  box(k) {
    const { bounds } = this.items[k];
    if (!bounds) return null;
    const box = new THREE.Box3(...bounds.map((corner) => new THREE.Vector3(...corner)));
    return box.expandByScalar(0.15 * box.getSize(new THREE.Vector3()).length());
  }

  /** What lies below a point of the picture: the object, the place, its number. */
  pick(picker, x, y) {
    const meshes = this.items.slice(0, MOST).flatMap((item, k) => {
      if (!this.shows(item, this.seen)) return [];
      const own = [item.surface, item.spheres?.meshes[1]].filter((mesh) => mesh);
      return own.map((mesh) => [mesh, FIRST + k, mesh]);
    });
    const found = picker.at(x, y, meshes);
    if (!found) return null;
    const item = this.items[found.kind - FIRST];
    const { balls, points, triangles, ids } = item;
    // Triangles come before spheres of the same object.
    if (item.spheres && !(item.surface && 3 * found.index < triangles.length)) {
      return { item, place: [...balls.slice(4 * found.index, 4 * found.index + 3)], number: ids[found.index] };
    }
    const far = (n) => {
      const [u, v] = picker.project(points.subarray(3 * n, 3 * n + 3));
      return Math.hypot(u - x, v - y);
    };
    const corners = [...triangles.subarray(3 * found.index, 3 * found.index + 3)];
    const node = corners.reduce((best, n) => (far(n) < far(best) ? n : best));
    return { item, place: [...points.subarray(3 * node, 3 * node + 3)], number: ids[node] };
  }
}
