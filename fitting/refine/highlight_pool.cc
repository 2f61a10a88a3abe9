#include "fitting/refine/highlight_pool.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel/parallel.h"

namespace glint {
namespace {

constexpr int kRowsPerBlock = 4;

// Weighted mean and spread of values that are known to `sigma` each.
struct Moments {
  double weight = 0, sum = 0, squares = 0, noise = 0;

  void Add(double w, double value, double sigma) {
    weight += w;
    sum += w * value;
    squares += w * value * value;
    noise += w * sigma * sigma;
  }
  double Mean() const { return sum / weight; }
  double Variance() const { return std::max(0.0, squares / weight - Mean() * Mean()); }
  double Spread() const { return std::sqrt(Variance()); }
  // What is left of it when what the values' own uncertainty spreads is taken off.
  double TrueSpread() const { return std::sqrt(std::max(0.0, Variance() - noise / weight)); }
};

class Pooling {
 public:
  Pooling(const RefineResult& refined, const HighlightPoolOptions& options)
      : refined_(refined), options_(options), tone_(3 * refined.maps.texels()) {
    const SvbrdfMaps& maps = refined.maps;
    const double radius = options.radius * std::max(maps.width, maps.height);
    step_ =
        std::max(1, static_cast<int>(std::lround(2 * radius / std::max(1, options.samples - 1))));
    reach_ = std::max(1, static_cast<int>(std::lround(radius / step_)));
    for (size_t i = 0; i < tone_.size(); ++i) {
      tone_[i] = std::sqrt(std::max(0.0f, maps.planes[kDiffuseR * maps.texels() + i]));
    }
    const double nearness = 0.5 * reach_ * step_;  // half of the neighbourhood's radius
    for (int k = 0; k <= reach_; ++k) {
      const double distance = k * step_ / nearness;
      near_.push_back(std::exp(-0.5 * distance * distance));
    }
  }

  void Pool(int row, int column, HighlightPool* pool) const;

 private:
  double Likeness(size_t a, size_t b) const {
    const size_t texels = refined_.maps.texels();
    double squares = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double difference = tone_[c * texels + a] - tone_[c * texels + b];
      squares += difference * difference;
    }
    return std::exp(-0.5 * squares / (options_.likeness * options_.likeness));
  }
  double Sigma(int plane, size_t texel) const {
    return refined_.confidence[plane * refined_.maps.texels() + texel];
  }
  double Sure(int plane, size_t texel, double least) const {
    const double sigma = Sigma(plane, texel);
    return 1 / (sigma * sigma + least * least);
  }

  const RefineResult& refined_;
  const HighlightPoolOptions& options_;
  std::vector<float> tone_;  // square root of diffuse albedo, 3 planes
  std::vector<double> near_;
  int step_ = 1, reach_ = 1;
};

void Pooling::Pool(int row, int column, HighlightPool* pool) const {
  const SvbrdfMaps& maps = refined_.maps;
  const size_t texel = static_cast<size_t>(row) * maps.width + column;
  Moments roughness;
  std::array<Moments, 3> specular;
  for (int j = -reach_; j <= reach_; ++j) {
    const int r = row + j * step_;
    if (r < 0 || r >= maps.height) continue;
    for (int i = -reach_; i <= reach_; ++i) {
      const int c = column + i * step_;
      if (c < 0 || c >= maps.width) continue;
      const size_t other = static_cast<size_t>(r) * maps.width + c;
      // A little of everyone: a texel like no other still has a mean.
      const double alike = near_[static_cast<size_t>(std::abs(i))] *
                               near_[static_cast<size_t>(std::abs(j))] * Likeness(texel, other) +
                           1e-9;
      roughness.Add(alike * Sure(kSigmaRoughness, other, options_.least_sigma),
                    maps.plane(kRoughness)[other], Sigma(kSigmaRoughness, other));
      for (int k = 0; k < 3; ++k) {
        specular[static_cast<size_t>(k)].Add(
            alike * Sure(kSigmaSpecularR + k, other, 0.5 * options_.least_sigma),
            maps.plane(kSpecularR + k)[other], Sigma(kSigmaSpecularR + k, other));
      }
    }
  }
  pool->start.plane(kRoughness)[texel] = static_cast<float>(roughness.Mean());
  pool->roughness_error[texel] = static_cast<float>(options_.least_error + roughness.TrueSpread());
  for (int k = 0; k < 3; ++k) {
    pool->start.plane(kSpecularR + k)[texel] =
        static_cast<float>(specular[static_cast<size_t>(k)].Mean());
  }
  pool->specular_error[texel] =
      static_cast<float>(0.5 * options_.least_error + specular[1].Spread());
}

}  // namespace

HighlightPool PoolHighlights(const RefineResult& refined, const HighlightPoolOptions& options,
                             int threads) {
  const SvbrdfMaps& maps = refined.maps;
  HighlightPool pool{maps, std::vector<float>(maps.texels()), std::vector<float>(maps.texels())};
  const Pooling pooling(refined, options);
  ForEachBlock(maps.height, kRowsPerBlock, std::max(threads, 1), [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      for (int column = 0; column < maps.width; ++column) pooling.Pool(row, column, &pool);
    }
  });
  return pool;
}

}  // namespace glint
