#include "pipeline/export/metal_roughness.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/cpu/vector_clones.h"
#include "base/parallel/parallel.h"
#include "pipeline/export/best_base_color.h"
#include "pipeline/export/direction_pairs.h"
#include "pipeline/export/kind_costs.h"

namespace glint {
// Named, since MetalConverter holds some of it.
namespace metal_tables {

// That are tried: denser near 0, where F0 is a little above 0.04, and near 1, where a metal has a
// little diffuse light.
constexpr int kMetalnesses = 17;
// What a unit of negative log probability costs, of log radiance: a texel that no metal and no
// dielectric reflects like is off by so much in the mean (Laplace's distribution).
constexpr float kErrorScale = 0.1f;
constexpr double kLeastRoughness = 0.03;
constexpr int kRoughnessBins = 64;

// Of a label, or of a place between two.
double Metalness(double label) {
  const double t = std::clamp(label / (kMetalnesses - 1), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

std::vector<double> AllMetalnesses() {
  std::vector<double> all;
  for (int label = 0; label < kMetalnesses; ++label) all.push_back(Metalness(label));
  return all;
}

size_t BinOf(double roughness) {
  return static_cast<size_t>(
      std::clamp(static_cast<int>(roughness * kRoughnessBins), 0, kRoughnessBins - 1));
}

using TermsTable = std::vector<PairTerms>;  // by roughness

TermsTable TermsByRoughness(const SpecularLobes& lobes) {
  TermsTable table;
  for (int bin = 0; bin < kRoughnessBins; ++bin) {
    table.push_back(TermsOf(std::max(kLeastRoughness, (bin + 0.5) / kRoughnessBins), lobes));
  }
  return table;
}

struct Texel {
  std::array<float, 3> diffuse, specular;  // diffuse with its lobe's weight
  float roughness = 0;
};

Texel TexelOf(const SvbrdfMaps& maps, DiffuseWeight weight, size_t i) {
  Texel texel;
  for (int c = 0; c < 3; ++c) {
    const float specular = maps.plane(kSpecularR + c)[i];
    const float left = weight == DiffuseWeight::kOne ? 1 : 1 - specular;
    texel.specular[static_cast<size_t>(c)] = specular;
    texel.diffuse[static_cast<size_t>(c)] = maps.plane(kDiffuseR + c)[i] * left;
  }
  texel.roughness = maps.plane(kRoughness)[i];
  return texel;
}

using Costs = std::array<float, kMetalnesses>;

// What each metalness costs a channel, by its diffuse and specular albedo in steps of their roots
// and by roughness. Of a large map most texels share a cell, so each is computed once.
class CostTable {
 public:
  CostTable() : index_(kCells, kNone) {}

  // Computes what these cells cost and the table does not hold yet.
  void Add(const TermsTable& terms, const std::vector<std::uint32_t>& cells, int threads) {
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

  static std::uint32_t CellOf(float diffuse, float specular, float roughness) {
    return static_cast<std::uint32_t>((BinOf(roughness) * kSteps + StepOf(diffuse)) * kSteps +
                                      StepOf(specular));
  }
  const Costs& at(std::uint32_t cell) const { return costs_[index_[cell]]; }

 private:
  static constexpr size_t kSteps = 128;  // off by at most 1.6 % at an albedo of 0.25
  static constexpr size_t kCells = kRoughnessBins * kSteps * kSteps;
  static constexpr std::uint32_t kNone = 0xffffffff;

  static size_t StepOf(float albedo) {
    return static_cast<size_t>(
        std::lround(std::sqrt(std::clamp(albedo, 0.0f, 1.0f)) * (kSteps - 1)));
  }
  static float AlbedoOf(size_t step) {
    const float root = static_cast<float>(step) / (kSteps - 1);
    return root * root;
  }
  static Costs CostsOf(const TermsTable& terms, size_t cell) {
    const float specular = AlbedoOf(cell % kSteps), diffuse = AlbedoOf(cell / kSteps % kSteps);
    const PairTerms& pairs = terms[cell / (kSteps * kSteps)];
    Costs costs;
    for (int label = 0; label < kMetalnesses; ++label) {
      const auto metallic = static_cast<float>(Metalness(label));
      costs[static_cast<size_t>(label)] = BestBaseColor(pairs, metallic, diffuse, specular).error;
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

constexpr int kColours = 6;

// What the texels of some rows look like and what each metalness costs them, in planes.
struct Rows {
  Rows(int columns, int rows)
      : width(columns),
        height(rows),
        texels(static_cast<size_t>(columns) * static_cast<size_t>(rows)),
        colours(kColours * texels),
        costs(kMetalnesses * texels) {}
  const float* Colour(int k, int row, int column) const {
    return colours.data() + At(k, row, column);
  }
  const float* Cost(int label, int row, int column) const {
    return costs.data() + At(label, row, column);
  }

  int width, height;
  size_t texels;
  std::vector<float> colours;  // √ of albedos, in which steps look alike
  std::vector<float> costs;    // means over channels

 private:
  size_t At(int plane, int row, int column) const {
    return static_cast<size_t>(plane) * texels +
           static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
  }
};

void SetColours(const SvbrdfMaps& maps, size_t begin, size_t end, Rows* rows) {
  for (int k = 0; k < kColours; ++k) {
    const auto plane = maps.plane(k < 3 ? kDiffuseR + k : kSpecularR + k - 3);
    float* to = rows->colours.data() + static_cast<size_t>(k) * rows->texels;
    for (size_t i = begin; i < end; ++i) to[i] = std::sqrt(std::max(0.0f, plane[i]));
  }
}

// `texel_at` gives the texel of an index.
template <class TexelAt>
void SetCosts(const CostTable& table, const KindCosts& kinds,
              const std::vector<std::uint32_t>& cells, const TexelAt& texel_at, double blend_cost,
              size_t begin, size_t end, Rows* rows) {
  Costs blend;
  for (size_t label = 0; label < kMetalnesses; ++label) {
    const double m = Metalness(static_cast<double>(label));
    blend[label] = static_cast<float>(4 * blend_cost * m * (1 - m));
  }
  for (size_t i = begin; i < end; ++i) {
    const Costs &red = table.at(cells[3 * i]), &green = table.at(cells[3 * i + 1]),
                &blue = table.at(cells[3 * i + 2]);
    const Texel texel = texel_at(i);
    const KindLook look = KindLookOf(texel.diffuse, texel.specular);
    for (size_t label = 0; label < kMetalnesses; ++label) {
      rows->costs[label * rows->texels + i] = blend[label] + kErrorScale * kinds.At(label, look) +
                                              (red[label] + green[label] + blue[label]) / 3;
    }
  }
}

// Columns that are averaged together: what is summed of them stays in the nearest cache.
constexpr int kColumnsAtOnce = 128;
struct Sums {
  alignas(64) std::array<std::array<float, kColumnsAtOnce>, kMetalnesses> of{};
};

// How much each column's neighbour counts: Tukey's biweight of their colours' difference, near 0 a
// Gaussian of the deviation whose squared inverse is given, none from twice that deviation on.
GLINT_VECTOR_CLONES
void SharesOf(const std::array<const float*, kColours>& here,
              const std::array<const float*, kColours>& there, int count, float per_square,
              float* shares) {
  for (int c = 0; c < count; ++c) {
    float square = 0;
    for (size_t k = 0; k < kColours; ++k) {
      const float d = there[k][c] - here[k][c];
      square += d * d;
    }
    const float left = std::max(0.0f, 1 - 0.25f * per_square * square);
    shares[c] = left * left;
  }
}

GLINT_VECTOR_CLONES
void AddShares(const float* shares, const float* costs, int count, float* sum) {
  for (int c = 0; c < count; ++c) sum[c] += shares[c] * costs[c];
}

// Adds to the sums of `count` columns from `first` what their neighbours in row `other`, `offset`
// columns away, cost.
void AddNeighbours(const Rows& rows, int row, int other, int offset, int first, int count,
                   float per_square, Sums* sums) {
  const int begin = std::max(first, -offset);  // those whose neighbour is in the sample
  const int end = std::min(first + count, rows.width - offset);
  if (begin >= end) return;
  std::array<const float*, kColours> here, there;
  for (int k = 0; k < kColours; ++k) {
    here[static_cast<size_t>(k)] = rows.Colour(k, row, begin);
    there[static_cast<size_t>(k)] = rows.Colour(k, other, begin + offset);
  }
  alignas(64) std::array<float, kColumnsAtOnce> shares;
  SharesOf(here, there, end - begin, per_square, shares.data());
  for (int label = 0; label < kMetalnesses; ++label) {
    AddShares(shares.data(), rows.Cost(label, other, begin + offset), end - begin,
              sums->of[static_cast<size_t>(label)].data() + (begin - first));
  }
}

// What each metalness costs the neighbourhoods of `count` columns from `first`.
Sums SumsOfNeighbours(const Rows& rows, int row, int first, int count, int radius,
                      float per_square) {
  Sums sums;
  for (int other = std::max(0, row - radius); other <= std::min(rows.height - 1, row + radius);
       ++other) {
    for (int offset = -radius; offset <= radius; ++offset) {
      AddNeighbours(rows, row, other, offset, first, count, per_square, &sums);
    }
  }
  return sums;
}

// Where a parabola through the least cost and its neighbours is least.
double BestMetalness(const Costs& costs) {
  const auto best =
      static_cast<size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  const auto label = static_cast<double>(best);
  if (best == 0 || best == kMetalnesses - 1) return Metalness(label);
  const double below = costs[best - 1], at = costs[best], above = costs[best + 1];
  const double curvature = below - 2 * at + above;
  const double shift = curvature > 1e-12 ? 0.5 * (below - above) / curvature : 0;
  return Metalness(label + shift);
}

}  // namespace metal_tables

using namespace metal_tables;

std::array<float, 3> MetalRoughness::ColorAt(size_t texel) const {
  return {base_color[texel], base_color[metallic.size() + texel],
          base_color[2 * metallic.size() + texel]};
}

struct MetalConverter::Tables {
  Tables(const SpecularLobes& lobes, double metal_share)
      : terms(TermsByRoughness(lobes)), kinds(AllMetalnesses(), metal_share) {}

  TermsTable terms;
  CostTable costs;
  KindCosts kinds;
};

MetalConverter::MetalConverter(const ReflectanceConvention& convention,
                               const MetalRoughnessOptions& options, int threads)
    : convention_(convention),
      options_(options),
      threads_(threads),
      tables_(new Tables(convention.lobes, options.metal_share)) {}

MetalConverter::~MetalConverter() = default;

MetalRoughness MetalConverter::Convert(const SvbrdfMaps& maps, int above, int below) {
  const auto texels = static_cast<int>(maps.texels());
  std::vector<std::uint32_t> cells(3 * maps.texels());
  Rows rows(maps.width, maps.height);
  constexpr int kBlock = 4096;
  ForEachBlock(texels, kBlock, threads_, [&](int begin, int end) {
    SetColours(maps, static_cast<size_t>(begin), static_cast<size_t>(end), &rows);
    for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const std::array<std::uint32_t, 3> own =
          CellsOf(TexelOf(maps, convention_.diffuse_weight, i));
      std::copy(own.begin(), own.end(), cells.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
  });
  tables_->costs.Add(tables_->terms, cells, threads_);
  ForEachBlock(texels, kBlock, threads_, [&](int begin, int end) {
    SetCosts(
        tables_->costs, tables_->kinds, cells,
        [&](size_t i) { return TexelOf(maps, convention_.diffuse_weight, i); }, options_.blend_cost,
        static_cast<size_t>(begin), static_cast<size_t>(end), &rows);
  });
  const int converted = maps.height - above - below;
  MetalRoughness result{maps.width, converted, {}, {}};
  result.metallic.resize(static_cast<size_t>(maps.width) * static_cast<size_t>(converted));
  result.base_color.resize(3 * result.metallic.size());
  ForEachPiece(converted, threads_, [&](int row) { ConvertRow(maps, rows, above, row, &result); });
  return result;
}

void MetalConverter::ConvertRow(const SvbrdfMaps& maps, const Rows& rows, int above, int row,
                                MetalRoughness* result) const {
  const auto per_square = static_cast<float>(1 / (options_.colour_width * options_.colour_width));
  const size_t converted = result->metallic.size();
  for (int first = 0; first < maps.width; first += kColumnsAtOnce) {
    const int count = std::min(kColumnsAtOnce, maps.width - first);
    const Sums sums =
        SumsOfNeighbours(rows, above + row, first, count, options_.radius, per_square);
    for (int c = 0; c < count; ++c) {
      const size_t column = static_cast<size_t>(first) + static_cast<size_t>(c);
      const auto width = static_cast<size_t>(maps.width);
      Costs costs;
      for (size_t k = 0; k < kMetalnesses; ++k) costs[k] = sums.of[k][static_cast<size_t>(c)];
      const auto metallic = static_cast<float>(BestMetalness(costs));
      const size_t to = static_cast<size_t>(row) * width + column;
      result->metallic[to] = metallic;
      const Texel texel = TexelOf(maps, convention_.diffuse_weight,
                                  static_cast<size_t>(above + row) * width + column);
      const PairTerms& pairs = tables_->terms[BinOf(texel.roughness)];
      for (size_t k = 0; k < 3; ++k) {
        result->base_color[k * converted + to] =
            BestBaseColor(pairs, metallic, texel.diffuse[k], texel.specular[k]).base;
      }
    }
  }
}

MetalRoughness ToMetalRoughness(const SvbrdfMaps& maps, const ReflectanceConvention& convention,
                                const MetalRoughnessOptions& options, int threads) {
  return MetalConverter(convention, options, threads).Convert(maps, 0, 0);
}

std::array<double, 3> MetalRoughnessBrdf(const std::array<float, 3>& base_color, double metallic,
                                         double roughness, const DirectionPair& pair) {
  const double lobe = SmithSpecular(pair, roughness), fresnel = SchlickWeight(pair.v_dot_h);
  const LinearInBase dielectric = DielectricReflectance(lobe, fresnel);
  const LinearInBase metal = MetalReflectance(lobe, fresnel);
  const double slope = (1 - metallic) * dielectric.slope + metallic * metal.slope;
  const double rest = (1 - metallic) * dielectric.rest + metallic * metal.rest;
  std::array<double, 3> brdf;
  for (size_t c = 0; c < 3; ++c) brdf[c] = slope * base_color[c] + rest;
  return brdf;
}

Shading MetalRoughnessShading(const MetalRoughness& converted, const SvbrdfMaps& maps) {
  return [&](size_t texel, const DirectionPair& pair) {
    return MetalRoughnessBrdf(converted.ColorAt(texel), converted.metallic[texel],
                              maps.plane(kRoughness)[texel], pair);
  };
}

}  // namespace glint
