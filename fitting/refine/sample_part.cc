#include "fitting/refine/sample_part.h"

#include <algorithm>
#include <numbers>

namespace glint {
namespace {

// Median over the views of π·I/(E·NoL), the albedo of a matte texel: highlights are rare among
// them.
std::vector<float> MedianColour(const RefineProblem& problem) {
  const SamplePlane& plane = problem.plane;
  const size_t texels = static_cast<size_t>(plane.width) * static_cast<size_t>(plane.height);
  std::vector<float> colour(3 * texels);
  std::vector<float> seen[3];
  for (size_t i = 0; i < texels; ++i) {
    const int row = static_cast<int>(i) / plane.width, column = static_cast<int>(i) % plane.width;
    for (auto& values : seen) values.clear();
    for (const RefineView& view : problem.views) {
      if (!(view.mask[i] >= 0.5f)) continue;
      const TexelGeometry<double> g = TexelGeometryInView<double>(
          view.view, problem.convention.falloff, plane.x_mm(column), plane.y_mm(row));
      for (size_t c = 0; c < 3; ++c) {
        const double received = g.irradiance[c] * std::max(0.05, g.light[2]);
        seen[c].push_back(
            static_cast<float>(std::numbers::pi * view.rgb[c * texels + i] / received));
      }
    }
    for (size_t c = 0; c < 3; ++c) {
      if (seen[c].empty()) continue;
      const auto middle = seen[c].begin() + static_cast<std::ptrdiff_t>((seen[c].size() - 1) / 2);
      std::nth_element(seen[c].begin(), middle, seen[c].end());
      colour[c * texels + i] = *middle;
    }
  }
  return colour;
}

}  // namespace

SamplePart::SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
                       const std::optional<Substances>& known, int most)
    : SamplePart(problem, initial, MedianColour(problem), known, most) {}

SamplePart::SamplePart(const RefineProblem& problem, const SvbrdfMaps& initial,
                       const std::vector<float>& colour, const std::optional<Substances>& known,
                       int most)
    : problem_(problem),
      initial_(initial),
      substances_(known ? *known : Substances(colour, most)),
      shares_(substances_.SharesOf(colour)) {}

}  // namespace glint
