#include "pipeline/export/metal_roughness.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/parallel/parallel.h"
#include "fitting/reflectance/brdf.h"
#include "fitting/reflectance/log_radiance.h"
#include "pipeline/export/direction_pairs.h"

namespace glint {
// Named, since MetalConverter holds some of it.
namespace metal_tables {

// That are tried: denser near 0, where F0 is a little above 0.04, and near 1, where a metal has a
// little diffuse light.
constexpr int kMetalnesses = 17;
constexpr double kLeastRoughness = 0.03;
constexpr int kRoughnessBins = 64;
constexpr size_t kMostPairs = 64;

// Of a label, or of a place between two.
double Metalness(double label) {
  const double t = std::clamp(label / (kMetalnesses - 1), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// One pair's part of the target that does not depend on the texel's colour.
struct PairTerms {
  double ours = 0;         // our D·G/(4·NoL·NoV) …
  double our_fresnel = 0;  // … and the power in our F
  double specular = 0;     // the target's
  double fresnel = 0;
  double received = 0;  // π·NoL: radiance of f under unit irradiance, white matte 1
};

// The target as slope·base + rest.
struct Linear {
  double slope = 0, rest = 0;
};

Linear TargetOf(const PairTerms& pair, double metallic) {
  const double dielectric = kDielectricF0 + (1 - kDielectricF0) * pair.fresnel;
  return {(1 - metallic) * (1 - dielectric) / std::numbers::pi +
              metallic * pair.specular * (1 - pair.fresnel),
          pair.specular * ((1 - metallic) * dielectric + metallic * pair.fresnel)};
}

PairTerms TermsOf(const DirectionPair& pair, double roughness) {
  TexelSvbrdf<double> texel{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, roughness};
  return {SpecularFactor(texel, pair.geometry), pair.geometry.fresnel,
          SmithSpecular(pair, roughness), SchlickWeight(pair.v_dot_h),
          std::numbers::pi * pair.light[2]};
}

// By roughness: the terms of its pairs.
std::vector<std::vector<PairTerms>> TermsByRoughness() {
  std::vector<std::vector<PairTerms>> table;
  for (int bin = 0; bin < kRoughnessBins; ++bin) {
    const double roughness = std::max(kLeastRoughness, (bin + 0.5) / kRoughnessBins);
    std::vector<PairTerms>& terms = table.emplace_back();
    for (const DirectionPair& pair : PairsForRoughness(roughness)) {
      terms.push_back(TermsOf(pair, roughness));
    }
  }
  return table;
}

struct Texel {
  std::array<double, 3> diffuse, specular;  // diffuse with its lobe's weight
  double roughness = 0;
};

Texel TexelOf(const SvbrdfMaps& maps, DiffuseWeight weight, size_t i) {
  Texel texel;
  for (int c = 0; c < 3; ++c) {
    const double specular = maps.plane(kSpecularR + c)[i];
    const double left = weight == DiffuseWeight::kOne ? 1 : 1 - specular;
    texel.specular[static_cast<size_t>(c)] = specular;
    texel.diffuse[static_cast<size_t>(c)] = maps.plane(kDiffuseR + c)[i] * left;
  }
  texel.roughness = maps.plane(kRoughness)[i];
  return texel;
}

// The best base colour of a channel, and the mean error that it leaves.
struct Best {
  double base = 0, error = 0;
};

// Of log radiance; errors below count as squares, larger ones as they are: a highlight that the
// target cannot have is not to spoil what it can.
constexpr double kRobustScale = 0.05;
constexpr int kReweightings = 4;

Best BestBase(const std::vector<PairTerms>& pairs, double metallic, double diffuse,
              double specular) {
  std::array<double, kMostPairs> ours, slopes, rests, weights;  // radiances, 0.01 added to ours
  const size_t count = std::min(pairs.size(), ours.size());
  for (size_t i = 0; i < count; ++i) {
    const PairTerms& pair = pairs[i];
    const double brdf =
        diffuse / std::numbers::pi + pair.ours * (specular + (1 - specular) * pair.our_fresnel);
    const Linear target = TargetOf(pair, metallic);
    ours[i] = pair.received * brdf + kLogOffset;
    slopes[i] = pair.received * target.slope;
    rests[i] = pair.received * target.rest + kLogOffset;
    weights[i] = 1 / (ours[i] * ours[i]);
  }
  Best best;
  for (int round = 0; round < kReweightings; ++round) {
    double squares = 1e-12, products = 0;
    for (size_t i = 0; i < count; ++i) {
      squares += weights[i] * slopes[i] * slopes[i];
      products += weights[i] * slopes[i] * (ours[i] - rests[i]);
    }
    best.base = std::clamp(products / squares, 0.0, 1.0);
    best.error = 0;
    for (size_t i = 0; i < count; ++i) {
      // 2(x − 1)/(x + 1) is log x to third order.
      const double theirs = best.base * slopes[i] + rests[i], mean = 0.5 * (theirs + ours[i]);
      const double off = (theirs - ours[i]) / mean;
      const double size = std::sqrt(off * off + kRobustScale * kRobustScale);
      weights[i] = 1 / (size * mean * mean);
      best.error += (size - kRobustScale) / static_cast<double>(count);
    }
  }
  return best;
}

const std::vector<PairTerms>& PairsOf(const std::vector<std::vector<PairTerms>>& table,
                                      double roughness) {
  const int bin = std::clamp(static_cast<int>(roughness * kRoughnessBins), 0, kRoughnessBins - 1);
  return table[static_cast<size_t>(bin)];
}

// √ of albedos, in which steps look alike.
std::array<float, 6> ColourOf(const SvbrdfMaps& maps, size_t i) {
  std::array<float, 6> colour;
  for (int c = 0; c < 3; ++c) {
    colour[static_cast<size_t>(c)] = std::sqrt(std::max(0.0f, maps.plane(kDiffuseR + c)[i]));
    colour[static_cast<size_t>(3 + c)] = std::sqrt(std::max(0.0f, maps.plane(kSpecularR + c)[i]));
  }
  return colour;
}

using Costs = std::array<float, kMetalnesses>;

// What each metalness costs a channel, by its diffuse and specular albedo in steps of their roots
// and by roughness. Of a large map most texels share a cell, so each is computed once.
class CostTable {
 public:
  CostTable() : index_(kCells, kNone) {}

  // Computes what these cells cost and the table does not hold yet.
  void Add(const std::vector<std::vector<PairTerms>>& terms,
           const std::vector<std::uint32_t>& cells, int threads) {
    const size_t known = used_.size();
    for (const std::uint32_t cell : cells) {
      if (index_[cell] != kNone) continue;
      index_[cell] = static_cast<std::uint32_t>(used_.size());
      used_.push_back(cell);
    }
    costs_.resize(used_.size());
    ForEachBlock(static_cast<int>(used_.size() - known), 256, threads, [&](int begin, int end) {
      for (size_t i = known + static_cast<size_t>(begin); i < known + static_cast<size_t>(end);
           ++i) {
        costs_[i] = CostsOf(terms, used_[i]);
      }
    });
  }

  static std::uint32_t CellOf(double diffuse, double specular, double roughness) {
    return static_cast<std::uint32_t>((Bin(roughness) * kSteps + StepOf(diffuse)) * kSteps +
                                      StepOf(specular));
  }
  const Costs& at(std::uint32_t cell) const { return costs_[index_[cell]]; }

 private:
  static constexpr size_t kSteps = 128;  // off by at most 1.6 % at an albedo of 0.25
  static constexpr size_t kCells = kRoughnessBins * kSteps * kSteps;
  static constexpr std::uint32_t kNone = 0xffffffff;

  static size_t Bin(double roughness) {
    return static_cast<size_t>(
        std::clamp(static_cast<int>(roughness * kRoughnessBins), 0, kRoughnessBins - 1));
  }
  static size_t StepOf(double albedo) {
    return static_cast<size_t>(std::lround(std::sqrt(std::clamp(albedo, 0.0, 1.0)) * (kSteps - 1)));
  }
  static double AlbedoOf(size_t step) {
    const double root = static_cast<double>(step) / (kSteps - 1);
    return root * root;
  }
  static Costs CostsOf(const std::vector<std::vector<PairTerms>>& terms, size_t cell) {
    const double specular = AlbedoOf(cell % kSteps), diffuse = AlbedoOf(cell / kSteps % kSteps);
    const std::vector<PairTerms>& pairs = terms[cell / (kSteps * kSteps)];
    Costs costs;
    for (int label = 0; label < kMetalnesses; ++label) {
      costs[static_cast<size_t>(label)] =
          static_cast<float>(BestBase(pairs, Metalness(label), diffuse, specular).error);
    }
    return costs;
  }

  std::vector<std::uint32_t> used_;
  std::vector<std::uint32_t> index_;  // of a cell among those used
  std::vector<Costs> costs_;
};

// Those of a texel's three channels.
std::array<std::uint32_t, 3> CellsOf(const Texel& texel) {
  std::array<std::uint32_t, 3> cells;
  for (size_t c = 0; c < 3; ++c) {
    cells[c] = CostTable::CellOf(texel.diffuse[c], texel.specular[c], texel.roughness);
  }
  return cells;
}

// Where a parabola through the least cost and its neighbours is least.
double BestMetalness(const Costs& costs) {
  const int best = static_cast<int>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  if (best == 0 || best == kMetalnesses - 1) return Metalness(best);
  const double below = costs[static_cast<size_t>(best - 1)], at = costs[static_cast<size_t>(best)];
  const double above = costs[static_cast<size_t>(best + 1)];
  const double curvature = below - 2 * at + above;
  const double shift = curvature > 1e-12 ? 0.5 * (below - above) / curvature : 0;
  return Metalness(best + shift);
}

}  // namespace metal_tables

using namespace metal_tables;

std::array<float, 3> MetalRoughness::ColorAt(size_t texel) const {
  return {base_color[texel], base_color[metallic.size() + texel],
          base_color[2 * metallic.size() + texel]};
}

struct MetalConverter::Tables {
  std::vector<std::vector<PairTerms>> terms = TermsByRoughness();
  CostTable costs;
};

MetalConverter::MetalConverter(DiffuseWeight weight, const MetalRoughnessOptions& options,
                               int threads)
    : weight_(weight), options_(options), threads_(threads), tables_(new Tables) {}

MetalConverter::~MetalConverter() = default;

MetalRoughness MetalConverter::Convert(const SvbrdfMaps& maps, int above, int below) {
  const size_t texels = maps.texels();
  std::vector<std::array<float, 6>> colours(texels);
  std::vector<std::uint32_t> cells(3 * texels);
  ForEachBlock(static_cast<int>(texels), 4096, threads_, [&](int begin, int end) {
    for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      colours[i] = ColourOf(maps, i);
      const std::array<std::uint32_t, 3> own = CellsOf(TexelOf(maps, weight_, i));
      std::copy(own.begin(), own.end(), cells.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
  });
  CostTable& channel_costs = tables_->costs;
  channel_costs.Add(tables_->terms, cells, threads_);
  std::vector<Costs> costs(texels);
  ForEachBlock(static_cast<int>(texels), 4096, threads_, [&](int begin, int end) {
    for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const auto of = [&](size_t c, size_t label) {
        return channel_costs.at(cells[3 * i + c])[label];
      };
      for (size_t label = 0; label < kMetalnesses; ++label) {
        const double m = Metalness(static_cast<double>(label));
        costs[i][label] = static_cast<float>(4 * options_.blend_cost * m * (1 - m)) +
                          (of(0, label) + of(1, label) + of(2, label)) / 3;
      }
    }
  });
  const int rows = maps.height - above - below;
  const auto width = static_cast<size_t>(maps.width), converted = width * static_cast<size_t>(rows);
  MetalRoughness result{maps.width, rows, std::vector<float>(3 * converted),
                        std::vector<float>(converted)};
  const float narrow = static_cast<float>(0.5 / (options_.colour_width * options_.colour_width));
  ForEachBlock(rows, 8, threads_, [&](int begin, int end) {
    for (int row = above + begin; row < above + end; ++row) {
      for (int column = 0; column < maps.width; ++column) {
        const auto at = [&](int r, int c) {
          return static_cast<size_t>(r) * width + static_cast<size_t>(c);
        };
        const size_t i = at(row, column), o = at(row - above, column);
        Costs sum{};
        for (int r = std::max(0, row - options_.radius);
             r <= std::min(maps.height - 1, row + options_.radius); ++r) {
          for (int c = std::max(0, column - options_.radius);
               c <= std::min(maps.width - 1, column + options_.radius); ++c) {
            const size_t other = at(r, c);
            float distance = 0;
            for (size_t k = 0; k < 6; ++k) {
              const float d = colours[other][k] - colours[i][k];
              distance += d * d;
            }
            const float share = std::exp(-narrow * distance);
            for (size_t k = 0; k < kMetalnesses; ++k) sum[k] += share * costs[other][k];
          }
        }
        const double metallic = BestMetalness(sum);
        result.metallic[o] = static_cast<float>(metallic);
        const Texel texel = TexelOf(maps, weight_, i);
        const auto& pairs = PairsOf(tables_->terms, texel.roughness);
        for (size_t k = 0; k < 3; ++k) {
          result.base_color[k * converted + o] = static_cast<float>(
              BestBase(pairs, metallic, texel.diffuse[k], texel.specular[k]).base);
        }
      }
    }
  });
  return result;
}

MetalRoughness ToMetalRoughness(const SvbrdfMaps& maps, DiffuseWeight weight,
                                const MetalRoughnessOptions& options, int threads) {
  return MetalConverter(weight, options, threads).Convert(maps, 0, 0);
}

std::array<double, 3> MetalRoughnessBrdf(const std::array<float, 3>& base_color, double metallic,
                                         double roughness, const std::array<double, 3>& light,
                                         const std::array<double, 3>& camera) {
  const PairTerms terms = TermsOf(MakePair(light, camera), roughness);
  const Linear target = TargetOf(terms, metallic);
  std::array<double, 3> brdf;
  for (size_t c = 0; c < 3; ++c) brdf[c] = target.slope * base_color[c] + target.rest;
  return brdf;
}

double MetalRoughnessError(const MetalRoughness& converted, const SvbrdfMaps& maps,
                           DiffuseWeight weight) {
  const auto target = [&](size_t texel, const DirectionPair& pair) {
    return MetalRoughnessBrdf(converted.ColorAt(texel), converted.metallic[texel],
                              maps.plane(kRoughness)[texel], pair.light, pair.camera);
  };
  return ShadingError(maps, weight, target);
}

}  // namespace glint
