// The reflectance of a texel in all its views but for its albedos: inlined into the kernels.
#pragma once

#include <cmath>

#include "fitting/texel/texel_kernel.h"

namespace glint {
namespace {

// KernelRows::lobe(): values per view and their derivatives by slope_x, slope_y and roughness.
enum Lobe { kNormalLight, kByXNormalLight, kByYNormalLight, kLobe, kByXLobe, kByYLobe, kByRLobe };

// n·l, the specular factor S = D·G/(4·NoL·NoV)·NoL and their derivatives, per view.
[[gnu::always_inline]] inline void EvaluateLobes(const TexelObservations& observations,
                                                 const TexelValues& texel, KernelRows* rows) {
  const double px = texel[kSlopeX], py = texel[kSlopeY], r = texel[kRough];
  const double length = 1.0 / std::sqrt(1.0 + px * px + py * py);
  const double nx = px * length, ny = py * length, nz = length;
  // ∂n/∂slope = length·(axis − n·n_axis)
  const double xx = length * (1.0 - nx * nx), xy = -length * nx * ny, xz = -length * nx * nz;
  const double yx = xy, yy = length * (1.0 - ny * ny), yz = -length * ny * nz;
  const double alpha = r * r;
  const double k = alpha * 0.5 > kDenominatorClamp ? alpha * 0.5 : kDenominatorClamp;
  const double k_by_alpha = alpha * 0.5 > kDenominatorClamp ? 0.5 : 0.0;
  const double alpha2 = alpha * alpha;
  const double one_minus_k = 1.0 - k;

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
    const double nl = nl_free > kDotClamp ? nl_free : kDotClamp;
    const double nv = nv_free > kDotClamp ? nv_free : kDotClamp;
    const double nh = nh_free > kDotClamp ? nh_free : kDotClamp;
    const double nl_on = nl_free > kDotClamp ? 1.0 : 0.0;
    const double nv_on = nv_free > kDotClamp ? 1.0 : 0.0;
    const double nh_on = nh_free > kDotClamp ? 1.0 : 0.0;

    const double t_free = 1.0 + nh * nh * (alpha2 - 1.0);
    const double t = t_free > kDenominatorClamp ? t_free : kDenominatorClamp;
    const double t_on = t_free > kDenominatorClamp ? 1.0 : 0.0;
    const double a = nl * one_minus_k + k;
    const double b = nv * one_minus_k + k;
    const double inverse = 1.0 / (t * a * b);  // one division for three
    const double inverse_t = inverse * a * b;
    const double inverse_a = inverse * t * b;
    const double inverse_b = inverse * t * a;
    const double ratio = alpha * inverse_t;
    const double p = (0.25 * kInversePi) * inverse_a * inverse_b;
    const double s_per_nl = ratio * ratio * p;
    const double s = s_per_nl * nl;
    const double by_t = -2.0 * s * inverse_t * t_on;
    const double by_alpha = 2.0 * ratio * inverse_t * p * nl + by_t * 2.0 * alpha * nh * nh -
                            k_by_alpha * s * ((1.0 - nl) * inverse_a + (1.0 - nv) * inverse_b);
    const double by_nl = s_per_nl * k * inverse_a * nl_on;
    const double by_nv = -s * one_minus_k * inverse_b * nv_on;
    const double by_nh = by_t * 2.0 * nh * (alpha2 - 1.0) * nh_on;

    const double nl_x = xx * lx[v] + xy * ly[v] + xz * lz[v];
    const double nl_y = yx * lx[v] + yy * ly[v] + yz * lz[v];
    const double nv_x = xx * vx[v] + xy * vy[v] + xz * vz[v];
    const double nv_y = yx * vx[v] + yy * vy[v] + yz * vz[v];
    const double nh_x = xx * hx[v] + xy * hy[v] + xz * hz[v];
    const double nh_y = yx * hx[v] + yy * hy[v] + yz * hz[v];
    out_nl[v] = nl;
    out_nl_x[v] = nl_x * nl_on;
    out_nl_y[v] = nl_y * nl_on;
    out_s[v] = s;
    out_s_x[v] = by_nl * nl_x + by_nv * nv_x + by_nh * nh_x;
    out_s_y[v] = by_nl * nl_y + by_nv * nv_y + by_nh * nh_y;
    out_s_r[v] = by_alpha * 2.0 * r;
  }
}

}  // namespace
}  // namespace glint
