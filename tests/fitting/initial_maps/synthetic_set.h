// Photographs of known maps by Glint's own renderer.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/reflectance/svbrdf_maps.h"
#include "fitting/photographs/photographs.h"
#include "fitting/render/renderer.h"

namespace glint::test {

// DIR's geometry; view 0 from the top, the others round about. LDR: clipped at 1.
inline PhotographSet PhotographMaps(const SvbrdfMaps& maps, int count, bool ldr = true,
                                    double power = 1) {
  PhotographSet set;
  set.plane = {maps.width, maps.height, 2, 2, TexelSampling::kPixelCentres};
  set.convention = {DiffuseWeight::kOne, LightFalloff::kNone, TexelSampling::kPixelCentres};
  for (int i = 0; i < count; ++i) {
    const double angle = 2.4 * i, radius = i == 0 ? 0.0 : 0.4 + 0.6 * i / count;
    Photograph photo;
    photo.view = DirView(radius * std::cos(angle), radius * std::sin(angle));
    for (double& p : photo.view.light_rgb) p *= power;
    photo.ldr = ldr;
    photo.rgb.resize(3 * maps.texels());
    photo.mask.assign(maps.texels(), 1.0f);
    RenderView(maps, set.plane, photo.view, set.convention, photo.rgb.data());
    if (ldr) {
      for (float& x : photo.rgb) x = std::min(x, 1.0f);
    }
    set.photographs.push_back(std::move(photo));
  }
  return set;
}

// Flat, of one material.
inline SvbrdfMaps UniformMaps(int size, float diffuse, float specular, float roughness) {
  SvbrdfMaps maps(size, size);
  for (float& z : maps.plane(kNormalZ)) z = 1;
  for (int c = 0; c < 3; ++c) {
    for (float& x : maps.plane(kDiffuseR + c)) x = diffuse * (1.0f - 0.2f * static_cast<float>(c));
    for (float& x : maps.plane(kSpecularR + c)) x = specular;
  }
  for (float& x : maps.plane(kRoughness)) x = roughness;
  return maps;
}

}  // namespace glint::test
