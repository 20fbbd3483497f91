// Shaders: spheres as quads on which a ray is cut with the sphere, cylinders of force chains, surfaces with a field.
import * as THREE from 'three';
import { mapTexture } from 'colours';

/** Colour of a value, and light. `mode`: 0 map over the range, 1 constant, 2 place in a palette. */
const COMMON = /* glsl */ `
  uniform int mode; uniform vec3 tint; uniform sampler2D map; uniform vec2 range; uniform float bands;
  uniform float opacity; uniform vec3 light; uniform int picking; uniform float pickKind;
  vec3 colourOf(float v) {
    if (mode == 1) return tint;
    if (mode == 2) return texture2D(map, vec2((mod(v, 256.0) + 0.5) / 256.0, 0.5)).rgb;
    float t = clamp((v - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
    if (bands > 0.0) t = (floor(min(t, 0.99999) * bands) + 0.5) / bands;
    return texture2D(map, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  }
  vec3 lit(vec3 colour, vec3 normal) {
    float lamp = max(dot(normal, light), 0.0);
    float fill = max(normal.z, 0.0);
    return colour * (0.34 + 0.56 * lamp + 0.16 * fill);
  }
  vec4 numberOf(float n) {
    float low = mod(n, 256.0), mid = mod(floor(n / 256.0), 256.0), high = floor(n / 65536.0);
    return vec4(low / 255.0, mid / 255.0, high / 255.0, pickKind / 255.0);
  }`;

/** Uniforms that all materials have; `light` is shared. */
export const light = { value: new THREE.Vector3(0.4, 0.5, 0.77).normalize() };

function uniforms(extra = {}) {
  return {
    mode: { value: 1 }, tint: { value: new THREE.Vector3(0.7, 0.7, 0.7) }, map: { value: mapTexture('viridis') },
    range: { value: new THREE.Vector2(0, 1) }, bands: { value: 0 }, opacity: { value: 1 }, light,
    picking: { value: 0 }, pickKind: { value: 0 }, ...extra,
  };
}

export function sphereMaterial() {
  return new THREE.ShaderMaterial({
    uniforms: uniforms({ chosen: { value: new THREE.Vector2(-1, -1) }, places: { value: null }, values: { value: null } }),
    vertexShader: /* glsl */ `
      uniform vec2 chosen; uniform highp sampler2D places; uniform highp sampler2D values;
      varying vec3 at; varying vec4 ball; varying float item; varying float mark; varying float number;
      void main() {
        int n = gl_VertexID / 6, k = gl_VertexID - 6 * n;
        ivec2 cell = ivec2(n & 2047, n >> 11);
        vec4 place = texelFetch(places, cell, 0);
        // Corners of two triangles.
        vec2 corner = vec2(k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, k == 2 || k == 4 || k == 5 ? 1.0 : -1.0);
        vec3 c = (modelViewMatrix * vec4(place.xyz, 1.0)).xyz;
        float r = place.w, s = r;
        vec3 right = vec3(1.0, 0.0, 0.0), up = vec3(0.0, 1.0, 0.0);
        if (!isOrthographic) {
          float d = length(c);
          vec3 n = c / d;
          right = normalize(cross(n, up));
          up = cross(right, n);
          s = r * d / sqrt(max(d * d - r * r, 0.01 * d * d));
        }
        at = c + (corner.x * right + corner.y * up) * s;
        ball = vec4(c, r);
        item = texelFetch(values, cell, 0).r;
        number = float(n);
        mark = number >= chosen.x && number < chosen.y ? 1.0 : 0.0;
        gl_Position = r > 0.0 ? projectionMatrix * vec4(at, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
      }`,
    fragmentShader: /* glsl */ `${COMMON}
      uniform mat4 projectionMatrix;
      varying vec3 at; varying vec4 ball; varying float item; varying float mark; varying float number;
      void main() {
        vec3 from = isOrthographic ? vec3(at.xy, 0.0) : vec3(0.0);
        vec3 along = isOrthographic ? vec3(0.0, 0.0, -1.0) : normalize(at);
        vec3 to = ball.xyz - from;
        float t = dot(to, along);
        vec3 off = along * t - to;
        float rest = ball.w * ball.w - dot(off, off);
        if (rest < 0.0) discard;
        vec3 place = from + along * (t - sqrt(rest));
        vec3 normal = (place - ball.xyz) / ball.w;
        vec4 clip = projectionMatrix * vec4(place, 1.0);
        gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0);
        if (picking == 1) { gl_FragColor = numberOf(number); return; }
        vec3 colour = mix(colourOf(item), vec3(1.0, 0.0, 0.85), mark);
        float rim = 0.72 + 0.28 * smoothstep(0.0, 0.45, -dot(normal, along));
        gl_FragColor = vec4(lit(colour, normal) * rim, opacity);
      }`,
  });
}

export function chainMaterial() {
  return new THREE.ShaderMaterial({
    uniforms: uniforms({ thickness: { value: 0.01 }, least: { value: 0 }, most: { value: 1 } }),
    vertexShader: /* glsl */ `
      attribute vec3 first; attribute vec3 second; attribute float force;
      uniform float thickness; uniform float least; uniform float most;
      varying vec3 facing; varying float item;
      void main() {
        vec3 axis = second - first;
        float size = length(axis);
        vec3 k = axis / max(size, 1e-12);
        vec3 u = normalize(abs(k.z) < 0.9 ? cross(k, vec3(0.0, 0.0, 1.0)) : cross(k, vec3(1.0, 0.0, 0.0)));
        vec3 v = cross(k, u);
        float share = abs(force) / most;
        float r = thickness * max(share, 0.02);
        vec3 out_ = u * position.x + v * position.y;
        item = force;
        facing = normalize((modelViewMatrix * vec4(out_, 0.0)).xyz);
        vec4 place = modelViewMatrix * vec4(mix(first, second, position.z) + out_ * r, 1.0);
        gl_Position = share >= least && size > 0.0 ? projectionMatrix * place : vec4(2.0, 2.0, 2.0, 1.0);
      }`,
    fragmentShader: /* glsl */ `${COMMON}
      varying vec3 facing; varying float item;
      void main() {
        gl_FragColor = vec4(lit(colourOf(item), normalize(facing)), opacity);
      }`,
  });
}

/** A surface that moves by `factor` times `shift`; flat, or cut off at a plane (`cut`: normal, lower and upper end). */
export function surfaceMaterial() {
  return new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    uniforms: uniforms({
      factor: { value: 1 }, cut: { value: new THREE.Vector3() },
      ends: { value: new THREE.Vector2(-1e30, 1e30) },
    }),
    vertexShader: /* glsl */ `
      attribute vec3 shift; attribute float value;
      uniform float factor; uniform vec3 cut;
      varying vec3 at; varying float item; varying float along; varying float number;
      void main() {
        vec3 x = position + factor * shift;
        vec4 place = modelViewMatrix * vec4(x, 1.0);
        at = place.xyz;
        item = value;
        along = dot(cut, x);
        number = float(gl_VertexID / 3);
        gl_Position = projectionMatrix * place;
      }`,
    fragmentShader: /* glsl */ `${COMMON}
      uniform vec2 ends;
      varying vec3 at; varying float item; varying float along; varying float number;
      void main() {
        if (along < ends.x || along > ends.y) discard;
        if (picking == 1) { gl_FragColor = numberOf(floor(number + 0.5)); return; }
        vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
        if (normal.z < 0.0) normal = -normal;
        // Colours of a field must be found in the legend again: less shade.
        vec3 plain = colourOf(item);
        gl_FragColor = vec4(mode == 0 ? mix(plain, lit(plain, normal), 0.4) : lit(plain, normal), opacity);
      }`,
  });
}

/** Lines that move with a surface. */
export function lineMaterial(colour, opacity) {
  return new THREE.ShaderMaterial({
    transparent: true,
    depthWrite: false,
    uniforms: {
      tint: { value: new THREE.Vector3(...colour) }, opacity: { value: opacity }, factor: { value: 1 },
      cut: { value: new THREE.Vector3() }, ends: { value: new THREE.Vector2(-1e30, 1e30) },
    },
    vertexShader: /* glsl */ `
      attribute vec3 shift; uniform float factor; uniform vec3 cut; varying float along;
      void main() {
        vec3 x = position + factor * shift;
        along = dot(cut, x);
        gl_Position = projectionMatrix * modelViewMatrix * vec4(x, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      uniform vec3 tint; uniform float opacity; uniform vec2 ends; varying float along;
      void main() {
        if (along < ends.x || along > ends.y) discard;
        gl_FragColor = vec4(tint, opacity);
      }`,
  });
}
