// Texels of maps, and geometries, as the reflectance model's functions take them.
#pragma once

#include "base/reflectance/brdf.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

inline TexelSvbrdf<double> TexelAt(const SvbrdfMaps& maps, size_t i) {
  TexelSvbrdf<double> texel;
  for (int a = 0; a < 3; ++a) {
    texel.normal[a] = maps.plane(kNormalX + a)[i];
    texel.diffuse[a] = maps.plane(kDiffuseR + a)[i];
    texel.specular[a] = maps.plane(kSpecularR + a)[i];
  }
  texel.roughness = maps.plane(kRoughness)[i];
  return texel;
}

// The same geometry in numbers of type T, as constants where T carries derivatives.
template <class T>
TexelGeometry<T> GeometryAs(const TexelGeometry<double>& from) {
  TexelGeometry<T> to;
  for (int i = 0; i < 3; ++i) {
    to.light[i] = T(from.light[i]);
    to.camera[i] = T(from.camera[i]);
    to.half[i] = T(from.half[i]);
    to.irradiance[i] = T(from.irradiance[i]);
    to.ambient[i] = T(from.ambient[i]);
    to.ambient_specular[i] = T(from.ambient_specular[i]);
  }
  to.fresnel = T(from.fresnel);
  return to;
}

}  // namespace glint
