// What the figures of an experiment look like: truth and the methods' maps side by side.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/images/image.h"
#include "datasets/evaluation/experiment.h"

namespace glint {

inline constexpr int kSheetMaterials = 4;

// A block of a sheet: a title, and maps below one another, each line with its name.
struct SheetBlock {
  std::string title;
  std::vector<std::pair<std::string, SvbrdfMaps>> lines;
};

// Blocks below one another, columns as in DrawSheet().
Image DrawBlocks(const std::vector<SheetBlock>& blocks, int threads);

// One block for each of the first kSheetMaterials materials (downwards) and each condition (to the
// right). A block's lines are the truth and the methods, its columns normal, diffuse, specular,
// roughness and a rendering lit from the upper left, seen from the top; colours in gamma 2.2.
// Results that are not on disk leave their place empty.
Image DrawSheet(const Experiment& experiment, int threads);

}  // namespace glint
