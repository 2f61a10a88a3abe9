// Inside of glint_render: runs kernel jobs tile by tile, and makes them from Glint's types.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/reflectance/convention.h"
#include "base/reflectance/view.h"
#include "fitting/render/kernel.h"

namespace glint::kernel {

// Runs task(tile) once for every tile in [0, tiles), in any order, from any thread.
using TileRunner = std::function<void(int tiles, const std::function<void(int tile)>& task)>;

// Texel coordinates of a plane, kept for as long as jobs point into them.
template <class T>
struct Grid {
  explicit Grid(const SamplePlane& plane);
  std::vector<T> x_mm, y_mm;
};

template <class T>
View<T> MakeView(const glint::View& view);

// A job over `grid` with everything set but its maps, images and outputs.
template <class T>
Job<T> MakeJob(const Grid<T>& grid, const ReflectanceConvention& convention,
               std::span<const View<T>> views);

// Runs every job and returns its views' sums, one after the other. Tiles and the order of sums
// depend on the jobs' sizes only, so results are the same for any runner.
template <class T>
std::vector<ViewSums> RunJobs(std::span<const Job<T>> jobs, Mode mode, const TileRunner& runner,
                              InstructionSet set = BestInstructionSet());

// A runner on `threads` threads of its own.
TileRunner ThreadRunner(int threads);

}  // namespace glint::kernel
