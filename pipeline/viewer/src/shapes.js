// What wears the material. Units are half the sample's width; z points to the viewer.
import * as THREE from 'three';

function withTangents(geometry, tangentOf) {
  const normals = geometry.getAttribute('normal');
  const tangents = new Float32Array(3 * normals.count);
  for (let i = 0; i < normals.count; ++i) {
    tangents.set(tangentOf(normals.getX(i), normals.getY(i), normals.getZ(i)), 3 * i);
  }
  geometry.setAttribute('tangentDirection', new THREE.BufferAttribute(tangents, 3));
  return geometry;
}

function plane(aspect) {
  return withTangents(new THREE.PlaneGeometry(2, 2 / aspect), () => [1, 0, 0]);
}

// Longitude runs along x, seen from +z.
function sphere() {
  const geometry = new THREE.SphereGeometry(1, 128, 96);
  return withTangents(geometry, (x, y, z) => {
    const length = Math.hypot(x, z) || 1;
    return [z / length, 0, -x / length];
  });
}

export const shapes = {
  plane: { label: 'Plane', geometry: plane, tiles: () => [1, 1], distance: 3.1 },
  sphere: { label: 'Sphere', geometry: sphere, tiles: (aspect) => [4, 2 * aspect], distance: 4.2 },
  tiled: { label: 'Tiled 3 × 3', geometry: plane, tiles: () => [3, 3], distance: 3.1 },
};
