// A synthetic capture of a camera that stands still while the light moves: a dome, or a lamp held
// by hand. On disk as an RTI capture is, with the truth beside it:
//
//   OUT/light_000.jpg … (or .png)   OUT/dirs.lp
//   OUT/truth/svbrdf.exr            the sample's maps
//   OUT/truth/lights.json           where each lamp really was, its strength and colour; the mean
//                                   lamp's power, as [light] power takes it
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "datasets/synth/material_source.h"
#include "datasets/synth/sensor.h"

namespace glint {

struct DomeOptions {
  int lights = 60;
  double lowest_deg = 12, highest_deg = 80;  // elevation of the lamps
  double sample_mm = 100;                    // its side, which the picture shows
  double distance_mm = 0;                    // of the lamps; 0: ten sides
  double uneven = 0;      // standard deviation of the logarithm of lamps' strengths
  double colours = 0;     // of their red and blue over green
  double jitter_deg = 0;  // of the directions that dirs.lp tells: a lamp held by hand
  bool shadows = false;   // relief casts shadows
  double blur_px = 0.6;   // standard deviation by which lens and pixel spread a point
  SensorNoise noise;
  std::string format = "png";
  int jpeg_quality = 95;
};

// Deterministic. Throws UserError (a folder that is not empty, wrong options), EnvironmentError.
void WriteDome(const std::filesystem::path& folder, const MaterialSource& material,
               const DomeOptions& options, std::uint64_t seed, int threads);

}  // namespace glint
