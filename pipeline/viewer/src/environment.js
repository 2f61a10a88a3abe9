// The light of a room with windows and lamps, filtered for lobes of every width. three.js has it as
// a scene, so that no picture travels with the page.
import * as THREE from 'three';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

const kBlur = 0.04;  // radians: hides the edges of the room's boxes

// A cube map whose mip levels are prefiltered.
export function roomEnvironment(renderer) {
  const filter = new THREE.PMREMGenerator(renderer);
  const room = new RoomEnvironment();
  const { texture } = filter.fromScene(room, kBlur);
  room.dispose();
  filter.dispose();
  return texture;
}
