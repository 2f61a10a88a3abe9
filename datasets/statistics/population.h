// Many materials measured: the real ones of a folder, or the procedural ones of a range of seeds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/statistics/material_statistics.h"

namespace glint {

struct Population {
  std::string name;
  std::vector<std::string> materials;          // what each is called
  std::vector<MaterialStatistics> statistics;  // in the same order

  std::vector<double> Trait(glint::Trait trait) const;  // of every material where it is defined
  std::array<double, kHistogramBins> MeanHistogram(Channel channel) const;
  // log10 power of one band, one a material; −12 for nothing.
  std::vector<double> LogPower(SpectrumOf spectrum, int band) const;
};

// Materials named by `paths`: maps that datasets/map_formats reads, or folders of such folders,
// sorted by name. Throws UserError for a path that holds none.
std::vector<std::string> FindMaterials(const std::vector<std::string>& paths);

// Measures each of `materials` (datasets/synth's LoadMaterial reads them) at side × side texels.
// The result does not depend on `threads`. Throws UserError: a side that is no power of two from 8,
// maps that cannot be read.
Population MeasureMaterials(const std::string& name, const std::vector<std::string>& materials,
                            int side, int threads);

// "procedural:SEED" or "procedural:FAMILY:SEED" of `count` seeds from `first` on.
std::vector<std::string> ProceduralMaterials(const std::string& family, uint64_t first, int count);

}  // namespace glint
