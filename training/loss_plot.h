// The loss log of a training as a picture.
#pragma once

#include <filesystem>

namespace glint {

// Reads a log (train_loop.cc's columns) and writes an SVG: map, smoothness, rendering and
// validation loss against steps, both axes logarithmic. Throws std::runtime_error when the log
// cannot be read or the picture not be written.
void WriteLossPlot(const std::filesystem::path& log_csv, const std::filesystem::path& svg);

}  // namespace glint
