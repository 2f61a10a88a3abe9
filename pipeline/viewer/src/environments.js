// What the material can be lit by instead of a point light: the one place for an environment's name
// and how it is made.
import * as THREE from 'three';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

// Of a scene of lamps and walls, so that no picture travels with the page: a cube map whose mip
// levels are prefiltered for lobes of every width. `blur`, in radians, hides the scene's edges.
function filtered(renderer, scene, blur) {
  const filter = new THREE.PMREMGenerator(renderer);
  const { texture } = filter.fromScene(scene, blur);
  scene.dispose();
  filter.dispose();
  return texture;
}

// By the menu's key. `scale`: of its radiance; a white plane below is just not overexposed.
export const environments = {
  // A room with windows and lamps.
  environment: { label: 'Environment', make: (renderer) => filtered(renderer, new RoomEnvironment(), 0.04), scale: 0.5 },
};
