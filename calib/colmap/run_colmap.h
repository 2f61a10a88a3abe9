// Running the colmap program on a capture's photographs (Debian's package, on the CPU, headless).
//
// Everything it makes lies in one work folder: images/ (links to the photographs, or copies where
// COLMAP cannot read them), database.db, sparse/ (all models), model/ (the largest, its principal
// point refined where six photographs or more tell it), log.txt. One thread and a fixed seed:
// matching and mapping draw random numbers per thread, so more threads would give other models each
// time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calib/colmap/colmap_model.h"

namespace glint {

struct ColmapPhoto {
  std::filesystem::path file;
  std::string name;  // of the image in the resulting model
  int camera = 0;    // photographs of one number share their intrinsics
};

struct ColmapRunOptions {
  std::string camera_model = "RADIAL";
  int largest_px = 2000;          // features are looked for in a copy of at most this size
  std::string encoding = "auto";  // of the photographs, as capture.toml says
  std::uint64_t seed = 0;
  bool force = false;  // run although the last result is of the same photographs and options
};

struct ColmapRun {
  ColmapModel model;          // the largest that was found
  std::vector<bool> upright;  // per photo: COLMAP saw a copy, turned as EXIF says
  bool reused = false;
};

// Throws EnvironmentError where there is no such program.
std::filesystem::path FindColmap();

// Throws EnvironmentError (no program, disk full) and ComputationError, which names the log, where
// a step fails or no model is found.
ColmapRun RunColmap(const std::vector<ColmapPhoto>& photos, const ColmapRunOptions& options,
                    const std::filesystem::path& work);

}  // namespace glint
