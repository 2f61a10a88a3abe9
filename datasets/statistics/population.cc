#include "datasets/statistics/population.h"

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/parallel/parallel.h"
#include "datasets/statistics/fourier.h"
#include "datasets/synth/material_source.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

bool HoldsFiles(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) return true;
  }
  return false;
}

std::vector<std::string> FoldersIn(const fs::path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::vector<double> Population::Trait(glint::Trait trait) const {
  std::vector<double> values;
  for (const MaterialStatistics& one : statistics) {
    if (!std::isnan(one[trait])) values.push_back(one[trait]);
  }
  return values;
}

std::array<double, kHistogramBins> Population::MeanHistogram(Channel channel) const {
  std::array<double, kHistogramBins> mean{};
  for (const MaterialStatistics& one : statistics) {
    const auto& histogram = one.histogram[static_cast<size_t>(channel)];
    for (size_t i = 0; i < mean.size(); ++i) {
      mean[i] += histogram[i] / static_cast<double>(statistics.size());
    }
  }
  return mean;
}

std::vector<double> Population::LogPower(SpectrumOf spectrum, int band) const {
  std::vector<double> values;
  for (const MaterialStatistics& one : statistics) {
    const RadialSpectrum& power = one.spectrum[static_cast<size_t>(spectrum)];
    values.push_back(std::log10(power[static_cast<size_t>(band)] + 1e-12));
  }
  return values;
}

std::vector<std::string> FindMaterials(const std::vector<std::string>& paths) {
  std::vector<std::string> found;
  for (const std::string& path : paths) {
    const bool of_folders = fs::is_directory(path) && !HoldsFiles(path);
    const std::vector<std::string> inside = of_folders ? FoldersIn(path) : std::vector{path};
    if (inside.empty()) {
      throw UserError(path, "materials", "an empty folder",
                      "name maps, or a folder whose subfolders hold maps");
    }
    found.insert(found.end(), inside.begin(), inside.end());
  }
  return found;
}

Population MeasureMaterials(const std::string& name, const std::vector<std::string>& materials,
                            int side, int threads) {
  if (side < 8 || !IsPowerOfTwo(side)) {
    throw UserError("size: found " + std::to_string(side) +
                    "; give a power of two, at least 8, such as 256");
  }
  Population population;
  population.name = name;
  population.materials.resize(materials.size());
  population.statistics.resize(materials.size());
  ForEachPiece(static_cast<int>(materials.size()), threads, [&](int piece) {
    const size_t i = static_cast<size_t>(piece);
    const MaterialSource material = LoadMaterial(materials[i], side);
    population.materials[i] = material.name;
    population.statistics[i] = MeasureMaterial(material.maps);
  });
  return population;
}

std::vector<std::string> ProceduralMaterials(const std::string& family, uint64_t first, int count) {
  std::vector<std::string> materials;
  for (int i = 0; i < count; ++i) {
    materials.push_back("procedural:" + (family.empty() ? "" : family + ":") +
                        std::to_string(first + static_cast<uint64_t>(i)));
  }
  return materials;
}

}  // namespace glint
