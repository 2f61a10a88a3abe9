// The reflectance of a texel in all its views but for its albedos: inlined into the kernels.
#pragma once

#include <cmath>

#include "fitting/texel/texel_kernel.h"

namespace glint {
namespace {

// KernelRows::lobe(): values per view and their derivatives by slope_x, slope_y and roughness.
enum Lobe { kNormalLight, kByXNormalLight, kByYNormalLight, kLobe, kByXLobe, kByYLobe, kByRLobe };

// n·l, the specular lobe S of brdf_core.h and their derivatives, per view.
[[gnu::always_inline]] inline void EvaluateLobes(const TexelObservations& observations,
                                                 const TexelValues& texel, KernelRows* rows) {
  const double px = texel[kSlopeX], py = texel[kSlopeY], r = texel[kRough];
  const double length = 1.0 / std::sqrt(1.0 + px * px + py * py);
  const double nx = px * length, ny = py * length, nz = length;
  // ∂n/∂slope = length·(axis − n·n_axis)
  const double xx = length * (1.0 - nx * nx), xy = -length * nx * ny, xz = -length * nx * nz;
  const double yx = xy, yy = length * (1.0 - ny * ny), yz = -length * ny * nz;
  const double* __restrict lx = observations.plane(TexelObservations::kLightX);
  const double* __restrict ly = observations.plane(TexelObservations::kLightY);
  const double* __restrict lz = observations.plane(TexelObservations::kLightZ);
  const double* __restrict vx = observations.plane(TexelObservations::kCameraX);
  const double* __restrict vy = observations.plane(TexelObservations::kCameraY);
  const double* __restrict vz = observations.plane(TexelObservations::kCameraZ);
  const double* __restrict hx = observations.plane(TexelObservations::kHalfX);
  const double* __restrict hy = observations.plane(TexelObservations::kHalfY);
  const double* __restrict hz = observations.plane(TexelObservations::kHalfZ);
  double* __restrict out_nl = rows->lobe(kNormalLight);
  double* __restrict out_nl_x = rows->lobe(kByXNormalLight);
  double* __restrict out_nl_y = rows->lobe(kByYNormalLight);
  double* __restrict out_s = rows->lobe(kLobe);
  double* __restrict out_s_x = rows->lobe(kByXLobe);
  double* __restrict out_s_y = rows->lobe(kByYLobe);
  double* __restrict out_s_r = rows->lobe(kByRLobe);
  const int views = observations.padded_views();
#pragma GCC ivdep
  for (int v = 0; v < views; ++v) {
    const double nl_free = nx * lx[v] + ny * ly[v] + nz * lz[v];
    const double nv_free = nx * vx[v] + ny * vy[v] + nz * vz[v];
    const double nh_free = nx * hx[v] + ny * hy[v] + nz * hz[v];
    // n and h are unit vectors and these are doubles.
    const SpecularTerms<double> lobe =
        EvaluateSpecular<double>({nl_free, nv_free, nh_free, 1.0 - nh_free * nh_free}, r);
    const SpecularSlopes<double> by = DifferentiateSpecular(lobe, r);
    const double nl_on = nl_free > kDotClamp ? 1.0 : 0.0;

    const double nl_x = xx * lx[v] + xy * ly[v] + xz * lz[v];
    const double nl_y = yx * lx[v] + yy * ly[v] + yz * lz[v];
    const double nv_x = xx * vx[v] + xy * vy[v] + xz * vz[v];
    const double nv_y = yx * vx[v] + yy * vy[v] + yz * vz[v];
    const double nh_x = xx * hx[v] + xy * hy[v] + xz * hz[v];
    const double nh_y = yx * hx[v] + yy * hy[v] + yz * hz[v];
    out_nl[v] = lobe.n_dot_l;
    out_nl_x[v] = nl_x * nl_on;
    out_nl_y[v] = nl_y * nl_on;
    out_s[v] = lobe.value;
    out_s_x[v] = by.by_n_dot_l * nl_x + by.by_n_dot_v * nv_x + by.by_n_dot_h * nh_x;
    out_s_y[v] = by.by_n_dot_l * nl_y + by.by_n_dot_v * nv_y + by.by_n_dot_h * nh_y;
    out_s_r[v] = by.by_roughness;
  }
}

}  // namespace
}  // namespace glint
