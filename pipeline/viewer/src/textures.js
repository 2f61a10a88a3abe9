// The page's pictures as textures. Data of any kind is taken byte by byte: no colour management, no
// premultiplied alpha.
import * as THREE from 'three';

async function bitmapOf(uri) {
  const bytes = await (await fetch(uri)).blob();
  return createImageBitmap(bytes, {
    colorSpaceConversion: 'none', premultiplyAlpha: 'none', imageOrientation: 'flipY',
  });
}

export async function loadTexture(uri, isColour, anisotropy) {
  const texture = new THREE.Texture(await bitmapOf(uri));
  texture.colorSpace = isColour ? THREE.SRGBColorSpace : THREE.NoColorSpace;
  texture.flipY = false;  // the bitmap is flipped already: row 0 of a map is at +y
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.magFilter = THREE.LinearFilter;
  texture.anisotropy = anisotropy;
  texture.needsUpdate = true;
  return texture;
}
