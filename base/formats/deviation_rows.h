// Standard deviations of maps on disk, as confidence.exr has them, by rows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/images/exr_rows.h"
#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_deviations.h"
#include "base/resampling/resampling.h"

namespace glint {

// Names of the channels, in the order of DeviationPlane: those of svbrdf.exr without normal.Z.
const std::vector<std::string>& DeviationChannels();

// Writes them at another size, interpolated, in half precision. Throws EnvironmentError.
void WriteDeviations(const std::filesystem::path& file, const SvbrdfDeviations& deviations,
                     int width, int height, const ReflectanceConvention& convention);

// The file's deviations at another size, or some rows of them.
class ResampledDeviations {
 public:
  // Throws UserError: a channel is missing.
  ResampledDeviations(const std::filesystem::path& file, int width, int height);
  // Rows first_row … first_row + rows − 1. Throws UserError: a value that is not above 0.
  SvbrdfDeviations Read(int first_row, int rows);

 private:
  SvbrdfDeviations ReadFile(int first_row, int rows);

  std::filesystem::path file_;
  ExrReader reader_;
  std::vector<int> channels_;  // in the file, by plane
  std::vector<Taps> across_, down_;
};

}  // namespace glint
