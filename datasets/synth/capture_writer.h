// A synthetic capture on disk, as a phone and its owner would leave it, with the truth beside it.
//
//   OUT/capture.toml            ready for `glint run`; of the truth it holds the flash's offset
//   only OUT/photos/photo_000.jpg …  (or .png; .exr: linear float, not clipped)
//   OUT/truth/calib/manifest.json   cameras, poses, flash positions, light power: a manifest of
//   stage
//                                   "calib", so that whatever reads calib's result reads the truth
//   OUT/truth/svbrdf.exr        the sample's maps, of Glint's convention for photographs
//   OUT/truth/truth.json        the rest: sample, ambient light, albedos, noise
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/synth/capture_plan.h"
#include "datasets/synth/material_source.h"
#include "datasets/synth/sensor.h"

namespace glint {

struct SyntheticCaptureOptions {
  CapturePlanOptions plan;
  std::string format = "jpg";         // jpg, png, exr
  std::string encoding = "gamma2.2";  // of 8-bit photographs: gamma2.2, srgb, linear
  SensorNoise noise;
  double lens_blur_px =
      0.5;  // standard deviation of the lens's point spread, on top of the pixel's box
  int resolution_px = 1024;  // [sample] resolution_px of capture.toml
  int jpeg_quality = 95;
  bool tell_flash = true;  // capture.toml gives the flash's offset
  bool overwrite = false;  // replace a capture that is there
};

struct SyntheticCaptureSummary {
  int photos = 0, width_px = 0, height_px = 0;
  std::vector<double> clipped_share;  // per photo: pixels with a clipped channel, of all
  std::string BriefReport() const;
};

// Deterministic: the same options and material give the same files for any number of threads.
// Throws UserError (a capture is there already, wrong options) and EnvironmentError.
SyntheticCaptureSummary WriteSyntheticCapture(const std::filesystem::path& folder,
                                              const MaterialSource& material,
                                              const SyntheticCaptureOptions& options, int threads);

}  // namespace glint
