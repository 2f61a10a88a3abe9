// One material, drawn either as a thing to walk around and relight, or as one of its photographs
// saw it.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { environments } from './environments.js';
import fragment from './fragment.glsl';
import shading from './shading.glsl';
import { shapes } from './shapes.js';
import { loadTexture } from './textures.js';
import vertex from './vertex.glsl';

export const channels = ['Rendering', 'Diffuse', 'Specular (F0)', 'Roughness', 'Normal'];

const kLightDistance = 2.6;  // of half the width
const kMatteWhite = Math.PI; // radiance 1 of a white matte texel under it

export class MaterialScene {
  constructor(canvas, material) {
    this.material = material;
    this.aspect = material.size_mm[0] / material.size_mm[1];
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shader encodes
    this.renderer.setClearColor(0x000000, 0);
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.05, 50);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.addEventListener('change', () => this.draw());
    this.scene = new THREE.Scene();
    this.lightAcross = [-0.45, 0.55];  // of the light's direction, x and y
    this.exposure = 1;
    this.channel = 0;
    this.environment = null;
    this.environmentMaps = {};
  }

  async load() {
    const anisotropy = this.renderer.capabilities.getMaxAnisotropy();
    const { maps } = this.material;
    const [diffuse, specular, high, low, confidence] = await Promise.all([
      loadTexture(maps.diffuse, true, anisotropy), loadTexture(maps.specular, true, anisotropy),
      loadTexture(maps.geometry_high, false, anisotropy),
      loadTexture(maps.geometry_low, false, anisotropy),
      maps.confidence ? loadTexture(maps.confidence, false, anisotropy) : null,
    ]);
    this.uniforms = {
      diffuseMap: { value: diffuse }, specularMap: { value: specular },
      geometryHighMap: { value: high }, geometryLowMap: { value: low },
      confidenceMap: { value: confidence || diffuse },
      diffuseWhole: { value: this.material.diffuse_whole },
      lobeShares: { value: new THREE.Vector2(...this.material.lobes.shares) },
      lobeScales: { value: new THREE.Vector2(...this.material.lobes.scales) },
      lobeTail: { value: this.material.lobes.tail_exponent },
      lobeAnisotropy: { value: this.material.lobes.anisotropy },
      lobeDirection: { value: new THREE.Vector2(...this.material.lobes.direction) },
      coatF0: { value: this.material.lobes.coat_f0 },
      fallsOff: { value: true }, lighting: { value: 0 }, exposure: { value: 1 },
      channel: { value: 0 }, tiles: { value: new THREE.Vector2(1, 1) },
      lightPosition: { value: new THREE.Vector3() }, lightRadiance: { value: new THREE.Vector3() },
      beam: { value: new THREE.Vector2() },
      ambient: { value: new THREE.Vector3() }, eye: { value: new THREE.Vector3() },
      environmentMap: { value: null }, environmentLods: { value: 0 }, environmentTurn: { value: new THREE.Vector2(1, 0) },
    };
    this.mesh = new THREE.Mesh(undefined, new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, uniforms: this.uniforms, vertexShader: vertex,
      fragmentShader: `${shading}\n${fragment}`, side: THREE.DoubleSide,
    }));
    this.scene.add(this.mesh);
    this.wear('plane');
  }

  // An environment instead of the point light, or the point light again: any other name. It is made
  // when it is first asked for.
  useEnvironment(name) {
    this.environment = environments[name] || null;
    if (this.environment) {
      this.environmentMaps[name] ||= this.environment.make(this.renderer);
      const texture = this.environmentMaps[name];
      this.uniforms.environmentMap.value = texture;
      this.uniforms.environmentLods.value = texture.mipmaps.length - 1;
    }
    this.draw();
  }

  wear(name) {
    const shape = shapes[name];
    this.shape = name;
    this.mesh.geometry.dispose();
    this.mesh.geometry = shape.geometry(this.aspect);
    this.uniforms.tiles.value.set(...shape.tiles(this.aspect));
    const from = name === 'sphere' ? [0, 0, 1] : [0, -0.9, 1];
    this.camera.position.set(...from).normalize().multiplyScalar(this.distance());
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.draw();
  }

  // From where the whole thing is seen, in a narrow window too.
  distance() {
    return shapes[this.shape].distance * Math.max(1, 1.15 / this.camera.aspect);
  }

  resize(width, height, ratio) {
    const before = this.distance();
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.camera.position.multiplyScalar(this.distance() / before);
    this.draw();
  }

  // `x`, `y`: of the light's direction; from beyond the horizon it comes from the horizon.
  lightFrom(x, y) {
    const length = Math.hypot(x, y);
    const most = 0.98;
    this.lightAcross = length > most ? [x * most / length, y * most / length] : [x, y];
    this.draw();
  }

  draw() {
    if (!this.mesh || this.view) return;
    const u = this.uniforms;
    const [x, y] = this.lightAcross;
    const z = Math.sqrt(Math.max(0, 1 - x * x - y * y));
    u.lighting.value = this.environment ? 1 : 0;
    const azimuth = Math.atan2(y, x);
    u.environmentTurn.value.set(Math.cos(azimuth), Math.sin(azimuth));
    u.lightPosition.value.set(x, y, z).multiplyScalar(kLightDistance);
    u.lightRadiance.value.setScalar(
      this.environment ? this.environment.scale : kMatteWhite * kLightDistance * kLightDistance);
    u.ambient.value.set(0, 0, 0);
    u.fallsOff.value = true;
    u.exposure.value = this.exposure;
    u.channel.value = this.channel;
    u.eye.value.copy(this.camera.position);
    this.renderer.render(this.scene, this.camera);
  }

  // The plane from straight above, texel by pixel, as `view` photographed it.
  drawView(view, width, height) {
    const { size_mm: size, falls_off: fallsOff } = this.material;
    this.view = view;
    const u = this.uniforms;
    this.mesh.geometry.dispose();
    this.mesh.geometry = shapes.plane.geometry(this.aspect);
    this.mesh.scale.setScalar(size[0] / 2);  // millimetres
    u.tiles.value.set(1, 1);
    u.lighting.value = 0;
    u.lightPosition.value.set(...view.light_mm);
    u.lightRadiance.value.set(...view.light_rgb).multiplyScalar(view.exposure);
    u.beam.value.set(...view.beam);
    u.ambient.value.set(...view.ambient_rgb).multiplyScalar(view.exposure);
    u.fallsOff.value = fallsOff;
    u.exposure.value = 1;
    u.channel.value = 0;
    u.eye.value.set(...view.camera_mm);
    const above = new THREE.OrthographicCamera(
      -size[0] / 2, size[0] / 2, size[1] / 2, -size[1] / 2, 0, 10);
    above.position.set(0, 0, 5);
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.renderer.render(this.scene, above);
  }

  leaveView() {
    this.view = null;
    this.uniforms.beam.value.set(0, 0);
    this.mesh.scale.setScalar(1);
    this.wear(this.shape);
  }
}
