// Radiance of a spot of paper. See light.h.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/reflectance/brdf_core.h"

namespace glint::light {

// What of a spot no unknown changes.
struct SpotGeometry {
  Eigen::Vector3d spot_in_camera_mm;
  Eigen::Vector3d normal_in_camera;  // of the board, toward the viewer
  double r2 = 0;                     // see VignettingRadius2
  double smear = 0;                  // see SmearOf
};

// How much of the ink's blur and of JPEG's ringing reaches a spot, relative to one beside ink: a
// JPEG block is 8 pixels wide, a lens's point spread narrower.
inline double SmearOf(double ink_px) { return std::exp(-ink_px / 4); }

inline constexpr double kGlossRoughness = 0.6;
inline constexpr double kPi = 3.14159265358979323846;

// π·D·G/(4·NoL·NoV) of the lobe, times NoL-free: the gloss over a white Lambertian reflection, for
// a reflectance of 1 at normal incidence. Fresnel's rise is left out: it needs grazing light.
template <class T>
T GlossOverWhite(const T& n_dot_l, const T& n_dot_v, const T& n_dot_h) {
  const Cosines<T> cosines{n_dot_l, n_dot_v, n_dot_h, T(1) - n_dot_h * n_dot_h};
  return EvaluateSpecular(cosines, T(kGlossRoughness)).over_cosine * T(kPi);
}

// cosθ/d² · (1 + g) per unit of q; false where the flash is behind the board.
template <class T>
bool FlashOnSpot(const SpotGeometry& geometry, const T* flash_mm, const T& gloss, T* value) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  const Vector spot = geometry.spot_in_camera_mm.cast<T>();
  const Vector normal = geometry.normal_in_camera.cast<T>();
  const Vector way = Vector(flash_mm[0], flash_mm[1], flash_mm[2]) - spot;
  const T d2 = way.squaredNorm();
  const Vector to_light = way / sqrt(d2), to_camera = -spot / sqrt(spot.squaredNorm());
  const T n_dot_l = normal.dot(to_light), n_dot_v = normal.dot(to_camera);
  if (n_dot_l <= T(0) || n_dot_v <= T(0)) return false;
  const Vector half = to_light + to_camera;
  const T n_dot_h = normal.dot(half) / sqrt(half.squaredNorm());
  *value = n_dot_l / d2 * (T(1) + gloss * GlossOverWhite(n_dot_l, n_dot_v, n_dot_h));
  return true;
}

inline double Falloff(const SpotGeometry& geometry, const double* v) {
  const double r2 = geometry.r2;
  return 1 + r2 * (v[0] + r2 * (v[1] + r2 * v[2]));
}

// What a camera that is read with the wrong curve makes of radiance L: L^(1 + t1 + t2·x + t3·x²),
// x = ln L: phones' curves lift shadows and dim highlights within a factor of five. Black
// and what clips, 1, stay what they are.
inline double Toned(const double* tone, double radiance) {
  const double x = std::log(radiance);
  return radiance * std::exp(x * (tone[0] + x * (tone[1] + x * tone[2])));
}
// d ln(toned) / d ln(radiance).
inline double TonedSlope(const double* tone, double log_radiance) {
  return 1 + tone[0] + log_radiance * (2 * tone[1] + log_radiance * 3 * tone[2]);
}

// Parameter blocks: flash_mm[3], log_q[3], ambient[3] (a · reference), vignetting[3], gloss[1],
// smear[1] (the share of its light that ink takes from paper beside it), tone[3] (see Toned),
// log_exposure[3] (of R, G, B). `reference` (1/mm²) brings a to the size of 1. False where no light
// reaches the spot. Derivatives: spot_cost.h.
inline bool Predict(const SpotGeometry& geometry, double reference, const double* flash_mm,
                    const double* log_q, const double* ambient, const double* vignetting,
                    const double* gloss, const double* smear, const double* tone,
                    const double* log_exposure, double* radiance) {
  double flash = 0;
  if (!FlashOnSpot(geometry, flash_mm, gloss[0], &flash)) return false;
  const double seen = Falloff(geometry, vignetting) * (1 - smear[0] * geometry.smear);
  for (int c = 0; c < 3; ++c) {
    const double linear =
        seen * std::exp(log_exposure[c] + log_q[c]) * (flash + ambient[c] * reference);
    if (!(linear > 0)) return false;
    radiance[c] = Toned(tone, linear);
  }
  return true;
}

}  // namespace glint::light
