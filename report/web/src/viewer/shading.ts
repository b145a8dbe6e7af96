import * as THREE from "three";
import { mapBytes, type MapName } from "../colours";

/** What every surface and line of the view shares. */
export interface Shared {
  deflection: { value: number };
  /** xyz: normal, w: level; what lies beyond is cut away. */
  plane: { value: THREE.Vector4 };
  cut: { value: number };
  range: { value: THREE.Vector2 };
  map: { value: THREE.DataTexture };
}

export function mapTexture(name: MapName): THREE.DataTexture {
  const texture = new THREE.DataTexture(mapBytes(name), 256, 1);
  texture.minFilter = THREE.LinearFilter;
  texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

const MOVED = /* glsl */ `
  attribute vec3 displacement;
  uniform float deflection;
  varying vec3 reference;
  vec3 moved() {
    reference = position;
    return position + deflection * displacement;
  }
`;

const CUT = /* glsl */ `
  uniform vec4 plane;
  uniform float cut;
  varying vec3 reference;
  void cutAway() {
    if (cut > 0.5 && dot(reference, plane.xyz) > plane.w) discard;
  }
`;

/** A surface coloured by the attribute `value`; NaN is grey. */
export function fieldMaterial(shared: Shared): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    uniforms: { ...shared } as Record<string, THREE.IUniform>,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: /* glsl */ `
      ${MOVED}
      attribute float value;
      varying float shown;
      varying vec3 facing;
      void main() {
        shown = value;
        facing = normalMatrix * normal;
        gl_Position =
          projectionMatrix * modelViewMatrix * vec4(moved(), 1.0);
      }`,
    fragmentShader: /* glsl */ `
      ${CUT}
      uniform vec2 range;
      uniform sampler2D map;
      varying float shown;
      varying vec3 facing;
      void main() {
        cutAway();
        float t = clamp((shown - range.x) / max(range.y - range.x, 1e-30),
                        0.0, 1.0);
        vec3 colour = shown < -1e30
          ? vec3(0.62)
          : texture2D(map, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
        vec3 n = normalize(facing);
        float light = abs(dot(n, normalize(vec3(0.25, 0.35, 0.9))));
        gl_FragColor = vec4(colour * (0.55 + 0.5 * light), 1.0);
      }`,
  });
}

function oneColour(
  shared: Shared,
  colour: string,
  opacity: number,
): Record<string, THREE.IUniform> {
  return {
    ...shared,
    colour: { value: new THREE.Color(colour) },
    opacity: { value: opacity },
  };
}

/** A surface or its inside in one colour. */
export function plainMaterial(
  shared: Shared,
  colour: string,
  opacity = 1,
): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    uniforms: oneColour(shared, colour, opacity),
    side: THREE.DoubleSide,
    transparent: opacity < 1,
    depthWrite: opacity >= 1,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: /* glsl */ `
      ${MOVED}
      varying vec3 facing;
      void main() {
        facing = normalMatrix * normal;
        gl_Position =
          projectionMatrix * modelViewMatrix * vec4(moved(), 1.0);
      }`,
    fragmentShader: /* glsl */ `
      ${CUT}
      uniform vec3 colour;
      uniform float opacity;
      varying vec3 facing;
      void main() {
        cutAway();
        float light =
          abs(dot(normalize(facing), normalize(vec3(0.25, 0.35, 0.9))));
        gl_FragColor = vec4(colour * (0.5 + 0.55 * light), opacity);
      }`,
  });
}

export function lineMaterial(
  shared: Shared,
  colour: string,
  opacity = 1,
): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    uniforms: oneColour(shared, colour, opacity),
    transparent: opacity < 1,
    vertexShader: /* glsl */ `
      ${MOVED}
      void main() {
        gl_Position =
          projectionMatrix * modelViewMatrix * vec4(moved(), 1.0);
      }`,
    fragmentShader: /* glsl */ `
      ${CUT}
      uniform vec3 colour;
      uniform float opacity;
      void main() {
        cutAway();
        gl_FragColor = vec4(colour, opacity);
      }`,
  });
}
