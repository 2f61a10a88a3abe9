// A photographed toy material whose manifest is wrong about the views.
#pragma once

#include <cmath>
#include <vector>

#include "fitting/render/render_environment.h"
#include "fitting/render/renderer.h"
#include "fitting/view_correction/view_correction.h"
#include "tests/fitting/initial_maps/synthetic_set.h"

namespace glint::test {

inline constexpr double kAmbientShare = 0.05;

inline double WaveAcross(int row, int column) { return std::sin(0.31 * column + 0.1 * row); }
inline double WaveDown(int row, int column) { return std::sin(0.37 * row - 0.12 * column); }

// Mean of a wave over the texels.
inline double MeanOf(double (*wave)(int row, int column), int size) {
  double sum = 0;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) sum += wave(row, column);
  }
  return sum / (static_cast<double>(size) * size);
}

// Waves in two directions: structure that tells displacements along both axes. Slopes are level in
// the mean, as samples are.
inline SvbrdfMaps CrossedWaves(int size) {
  SvbrdfMaps maps(size, size);
  const double mean_across = MeanOf(WaveAcross, size), mean_down = MeanOf(WaveDown, size);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double across = WaveAcross(row, column), down = WaveDown(row, column);
      for (int c = 0; c < 3; ++c) {
        maps.at(kDiffuseR + c, row, column) =
            static_cast<float>(0.35 + 0.12 * across + 0.1 * down + 0.02 * c);
        maps.at(kSpecularR + c, row, column) = static_cast<float>(0.06 + 0.02 * down);
      }
      maps.at(kRoughness, row, column) = static_cast<float>(0.4 + 0.1 * across * down);
      const double x = 0.2 * (down - mean_down), y = 0.2 * (across - mean_across);
      const double z = 1 / std::sqrt(1 + x * x + y * y);
      maps.at(kNormalX, row, column) = static_cast<float>(x * z);
      maps.at(kNormalY, row, column) = static_cast<float>(y * z);
      maps.at(kNormalZ, row, column) = static_cast<float>(z);
    }
  }
  return maps;
}

struct DisturbedSet {
  SvbrdfMaps maps;         // the truth
  PhotographSet set;       // as believed
  ViewCorrections errors;  // what would make it right
};

// As below, with environment lighting of any kind.
inline DisturbedSet DisturbLitBy(const EnvironmentLighting& environment, int count,
                                 double light_off, double shift_texel, int size, bool together) {
  DisturbedSet made{CrossedWaves(size), {}, {}};
  made.set = PhotographMaps(made.maps, count, false);
  made.errors.environment = environment;
  for (int i = 0; i < count; ++i) {
    Photograph& photo = made.set.photographs[static_cast<size_t>(i)];
    ViewCorrection error;
    const Vec3d light = photo.view.light_in_sample_mm;
    const double distance = std::hypot(light[0], light[1], light[2]);
    const double angle = together ? 0.5 : 2.1 * i + 0.5;
    error.light_offset_mm = {light_off * distance * std::cos(angle),
                             light_off * distance * std::sin(angle), 0};
    for (int k = 0; k < 4; ++k) {
      error.shifts.column[k] = shift_texel * std::sin(3.7 * i + k);
      error.shifts.row[k] = shift_texel * std::cos(5.3 * i - k);
    }
    const View real = CorrectedView(photo.view, error);
    RenderView(made.maps, made.set.plane, real, made.set.convention, photo.rgb.data());
    AddEnvironmentLighting(environment, made.maps, made.set.plane, real, made.set.convention,
                           photo.rgb.data());
    // Looked up the other way: what a picture that is moved so shows.
    CornerShifts away;
    for (int k = 0; k < 4; ++k) {
      away.column[k] = -error.shifts.column[k];
      away.row[k] = -error.shifts.row[k];
    }
    ShiftPicture(away, size, size, &photo.rgb);
    made.errors.views.push_back(error);
  }
  return made;
}

// Every light `light_off` of its distance away from where it is believed to be, every picture moved
// by up to `shift_texel` at its corners (at most a texel), an even environment of kAmbientShare of
// the flash if `ambient`. `together`: all lights in one direction.
inline DisturbedSet Disturb(int count, double light_off, double shift_texel, bool ambient,
                            int size = 64, bool together = false) {
  EnvironmentLighting environment;
  if (ambient) environment.radiance_rgb = {{kAmbientShare, kAmbientShare, kAmbientShare}};
  return DisturbLitBy(environment, count, light_off, shift_texel, size, together);
}

}  // namespace glint::test
