#include "fitting/refine/sample_look.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/model/solver.h"
#include "base/model/substances.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/refine/lower_median.h"

namespace glint {
namespace {

using constants::kLookCells;

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

float LogRadianceOf(const RefineView& view, size_t texel) {
  const size_t texels = view.mask.size();
  float sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += std::max(0.0f, view.rgb[c * texels + texel]);
  return std::log(sum / 3 + static_cast<float>(kLogOffset));
}

bool Sees(const RefineView& view, size_t texel) { return view.mask[texel] >= 0.5f; }

// 0 … 1 across and down the whole sample.
struct Place {
  double x, y;
};
Place PlaceOnSample(const SamplePlane& plane, size_t texel) {
  const int column = static_cast<int>(texel) % plane.width;
  const int row = static_cast<int>(texel) / plane.width;
  return {plane.x_mm(column) / plane.width_mm + 0.5, 0.5 - plane.y_mm(row) / plane.height_mm};
}

int CellOf(double place) {
  return std::clamp(static_cast<int>(place * kLookCells), 0, kLookCells - 1);
}

size_t CellAt(int row, int column) {
  return static_cast<size_t>(row) * kLookCells + static_cast<size_t>(column);
}

// The logarithm of what a view's light sends to the middle of a cell.
double LogIrradiance(const RefineProblem& problem, const View& view, int column, int row) {
  const SamplePlane& plane = problem.plane;
  const double x_mm = ((column + 0.5) / kLookCells - 0.5) * plane.width_mm;
  const double y_mm = (0.5 - (row + 0.5) / kLookCells) * plane.height_mm;
  const TexelGeometry<double> at =
      TexelGeometryInView<double>(view, problem.convention.falloff, x_mm, y_mm);
  return std::log((at.irradiance[0] + at.irradiance[1] + at.irradiance[2]) / 3);
}

}  // namespace

SampleLook::SampleLook(const RefineProblem& problem, int threads) : typical_(problem.views.size()) {
  if (problem.views.size() < constants::kLeastGlossViews) return;
  const size_t texels = problem.views.front().mask.size();
  ForEachPiece(static_cast<int>(problem.views.size()), threads, [&](int v) {
    const RefineView& view = problem.views[static_cast<size_t>(v)];
    std::vector<std::vector<float>> by_cell(kLookCells * kLookCells);
    for (size_t t = 0; t < texels; ++t) {
      if (!Sees(view, t)) continue;
      const Place place = PlaceOnSample(problem.plane, t);
      by_cell[CellAt(CellOf(place.y), CellOf(place.x))].push_back(LogRadianceOf(view, t));
    }
    for (int cell = 0; cell < kLookCells * kLookCells; ++cell) {
      std::vector<float>& seen = by_cell[static_cast<size_t>(cell)];
      const float median = seen.empty() ? kUnseen : LowerMedian(&seen);
      const double received =
          LogIrradiance(problem, view.view, cell % kLookCells, cell / kLookCells);
      typical_[static_cast<size_t>(v)].push_back({median, median - static_cast<float>(received)});
    }
  });
  LearnVariances(LinesOf(problem, threads));
}

// Of lines with slopes b_i and information w_i: τ² is where Σ (b_i² − s²/w_i)/(τ² + s²/w_i)² is 0,
// the score of the likelihood.
void SampleLook::LearnVariances(const std::vector<Line>& lines) {
  double squares = 0, freedom = 0;
  for (const Line& line : lines) {
    squares += line.squares;
    freedom += line.freedom;
  }
  if (!(freedom > 0)) return;
  noise_ = squares / freedom;
  variance_ = 1;
  for (int i = 0; i < constants::kGlossIterations; ++i) {
    double sum = 0, weights = 0;
    for (const Line& line : lines) {
      if (line.freedom == 0) continue;
      const double error = noise_ / line.information;
      const double weight = 1 / ((variance_ + error) * (variance_ + error));
      sum += weight * (line.slope * line.slope - error);
      weights += weight;
    }
    variance_ = std::max(0.0, sum / weights);
  }
}

// Between the middles of the four cells about a place; beyond the outermost as there.
SampleLook::Typical SampleLook::TypicalAt(size_t view, double x, double y) const {
  const double u = std::clamp(x * kLookCells - 0.5, 0.0, kLookCells - 1.0);
  const double v = std::clamp(y * kLookCells - 0.5, 0.0, kLookCells - 1.0);
  const int column = std::min(static_cast<int>(u), kLookCells - 2);
  const int row = std::min(static_cast<int>(v), kLookCells - 2);
  const float s = static_cast<float>(u - column), t = static_cast<float>(v - row);
  const auto at = [&](int down, int across) -> const Typical& {
    return typical_[view][CellAt(row + down, column + across)];
  };
  const auto between = [&](float Typical::*of) {
    const float above = at(0, 0).*of * (1 - s) + at(0, 1).*of * s;
    const float below = at(1, 0).*of * (1 - s) + at(1, 1).*of * s;
    return above * (1 - t) + below * t;
  };
  return {between(&Typical::log_radiance), between(&Typical::highlight)};
}

SampleLook::Line SampleLook::LineOf(const RefineProblem& problem, size_t texel) const {
  const Place place = PlaceOnSample(problem.plane, texel);
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (size_t v = 0; v < problem.views.size(); ++v) {
    if (!Sees(problem.views[v], texel)) continue;
    const Typical typical = TypicalAt(v, place.x, place.y);
    if (std::isnan(typical.log_radiance)) continue;
    const double highlight = typical.highlight;
    const double departure = LogRadianceOf(problem.views[v], texel) - typical.log_radiance;
    n += 1;
    x += highlight;
    y += departure;
    xx += highlight * highlight;
    xy += highlight * departure;
    yy += departure * departure;
  }
  if (n < constants::kLeastGlossViews) return {};
  const double information = xx - x * x / n, both = xy - x * y / n;
  if (!(information > constants::kLeastGlossInformation)) return {};
  const double slope =
      std::clamp(both / information, -constants::kSteepestGloss, constants::kSteepestGloss);
  const double left = yy - y * y / n - both * both / information;
  return {static_cast<float>(slope), static_cast<float>(information),
          static_cast<float>(std::max(0.0, left)), static_cast<int>(n) - 2};
}

std::vector<SampleLook::Line> SampleLook::LinesOf(const RefineProblem& problem, int threads) const {
  constexpr int kBlock = 4096;
  std::vector<Line> lines(problem.views.front().mask.size());
  ForEachBlock(static_cast<int>(lines.size()), kBlock, threads, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      lines[static_cast<size_t>(t)] = LineOf(problem, static_cast<size_t>(t));
    }
  });
  return lines;
}

std::vector<float> SampleLook::GlossOf(const RefineProblem& problem, int threads) const {
  std::vector<float> gloss(problem.views.front().mask.size(), 0.0f);
  if (variance_ == 0) return gloss;
  const std::vector<Line> lines = LinesOf(problem, threads);
  for (size_t t = 0; t < gloss.size(); ++t) {
    if (lines[t].freedom == 0) continue;
    const double error = noise_ / lines[t].information;
    gloss[t] = static_cast<float>(variance_ / (variance_ + error) * lines[t].slope);
  }
  return gloss;
}

}  // namespace glint
