#include "fitting/render/batch.h"

#include <algorithm>
#include <memory>
#include <new>

#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"
#include "base/reflectance/brdf_constants.h"

namespace glint::kernel {
namespace {

constexpr int kMostTilesPerJob = 64;
constexpr std::align_val_t kScratchAlignment{64};

struct FreeAligned {
  void operator()(void* memory) const { ::operator delete(memory, kScratchAlignment); }
};
using Scratch = std::unique_ptr<void, FreeAligned>;

struct Tile {
  size_t job;
  int row_begin, row_end;
};

template <class T>
std::vector<Tile> CutIntoTiles(std::span<const Job<T>> jobs) {
  std::vector<Tile> tiles;
  for (size_t job = 0; job < jobs.size(); ++job) {
    const int height = jobs[job].height;
    const int rows = std::max(1, (height + kMostTilesPerJob - 1) / kMostTilesPerJob);
    for (int row = 0; row < height; row += rows) {
      tiles.push_back({job, row, std::min(row + rows, height)});
    }
  }
  return tiles;
}

}  // namespace

template <class T>
Grid<T>::Grid(const SamplePlane& plane) : x_mm(plane.width), y_mm(plane.height) {
  for (int i = 0; i < plane.width; ++i) x_mm[i] = static_cast<T>(plane.x_mm(i));
  for (int i = 0; i < plane.height; ++i) y_mm[i] = static_cast<T>(plane.y_mm(i));
}

template <class T>
View<T> MakeView(const glint::View& view) {
  View<T> made;
  for (int i = 0; i < 3; ++i) {
    made.camera_mm[i] = static_cast<T>(view.camera_in_sample_mm[i]);
    made.light_mm[i] = static_cast<T>(view.light_in_sample_mm[i]);
    made.exposed_light[i] = static_cast<T>(view.exposure * view.light_rgb[i]);
    made.exposed_ambient[i] = static_cast<T>(view.exposure * view.ambient_rgb[i]);
  }
  return made;
}

template <class T>
Job<T> MakeJob(const Grid<T>& grid, const ReflectanceConvention& convention,
               std::span<const View<T>> views) {
  Job<T> job;
  job.width = static_cast<int>(grid.x_mm.size());
  job.height = static_cast<int>(grid.y_mm.size());
  job.x_mm = grid.x_mm.data();
  job.y_mm = grid.y_mm.data();
  job.plane_stride = job.target_stride = job.gradient_stride = job.image_stride =
      grid.x_mm.size() * grid.y_mm.size();
  job.views = views.data();
  job.view_count = static_cast<int>(views.size());
  job.inverse_square = convention.falloff == LightFalloff::kInverseSquare;
  job.one_minus_specular = convention.diffuse_weight == DiffuseWeight::kOneMinusSpecular;
  job.mix = LobeMixOf<T>(convention.lobes);
  return job;
}

template <class T>
std::vector<ViewSums> RunJobs(std::span<const Job<T>> jobs, Mode mode, const TileRunner& runner,
                              InstructionSet set) {
  const std::vector<Tile> tiles = CutIntoTiles(jobs);
  std::vector<std::vector<ViewSums>> tile_sums(tiles.size());
  const RunRowsFunction<T> run_rows = RunRows<T>(set);
  runner(static_cast<int>(tiles.size()), [&](int index) {
    const Tile& tile = tiles[index];
    const Job<T>& job = jobs[tile.job];
    std::vector<ViewSums>& sums = tile_sums[index];
    sums.resize(job.view_count);
    const Scratch scratch(::operator new(ScratchBytes(job.view_count), kScratchAlignment));
    run_rows(job, mode, tile.row_begin, tile.row_end, scratch.get(), sums.data());
  });

  std::vector<size_t> first_view(jobs.size() + 1, 0);
  for (size_t j = 0; j < jobs.size(); ++j) first_view[j + 1] = first_view[j] + jobs[j].view_count;
  std::vector<ViewSums> totals(first_view.back());
  for (size_t t = 0; t < tiles.size(); ++t) {
    for (size_t v = 0; v < tile_sums[t].size(); ++v) {
      ViewSums& total = totals[first_view[tiles[t].job] + v];
      for (int i = 0; i < ViewSums::kCount; ++i) total.values[i] += tile_sums[t][v].values[i];
    }
  }
  return totals;
}

TileRunner ThreadRunner(int threads) {
  return [threads](int tiles, const std::function<void(int)>& task) {
    ForEachPiece(tiles, threads, task);
  };
}

#define GLINT_INSTANTIATE(T)                                                                       \
  template struct Grid<T>;                                                                         \
  template View<T> MakeView(const glint::View&);                                                   \
  template Job<T> MakeJob(const Grid<T>&, const ReflectanceConvention&, std::span<const View<T>>); \
  template std::vector<ViewSums> RunJobs(std::span<const Job<T>>, Mode, const TileRunner&,         \
                                         InstructionSet);
GLINT_INSTANTIATE(float)
GLINT_INSTANTIATE(double)
#undef GLINT_INSTANTIATE

}  // namespace glint::kernel
