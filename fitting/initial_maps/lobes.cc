#include "fitting/initial_maps/lobes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/reflectance/brdf.h"

namespace glint {
namespace {

// Angles between normal and half vector, degrees: fine where a polished sample's highlight lies.
constexpr std::array<double, 24> kBinEdges{0,  0.4, 0.8, 1.3,  2,  3,  4,  5.5, 7,  9,  11, 13.5,
                                           16, 19,  22,  25.5, 29, 33, 37, 42,  47, 53, 60, 70};
constexpr size_t kBins = kBinEdges.size() - 1;
constexpr size_t kMinInBin = 12;
constexpr double kMostWeight = 200;  // texels beyond which a bin counts no more
constexpr size_t kMaxSamples = 100'000;
constexpr double kClipped = 0.99;
constexpr double kOffset = 0.004;  // of the logarithms, in units of reflectance

constexpr std::array<double, 15> kTriedRoughnesses{0.06, 0.09, 0.13, 0.18, 0.23, 0.28, 0.34, 0.4,
                                                   0.46, 0.52, 0.59, 0.66, 0.74, 0.83, 0.93};
constexpr std::array<double, 12> kSpecular{0.025, 0.035, 0.045, 0.06, 0.08, 0.12,
                                           0.18,  0.26,  0.37,  0.5,  0.68, 0.9};
// Glints: near the mirror direction the brightest texels stand out more than elsewhere.
constexpr double kNearDegrees = 5.5, kFarDegrees = 16, kFarthestDegrees = 25.5;
constexpr double kBrightest = 0.995;
constexpr double kGlints = 4;           // ratio of the two; other materials stay below 2.3
constexpr double kMostPolished = 0.18;  // roughness of a sample with glints, at most

// Weak preferences, in squared log residual: they decide where the photographs do not.
constexpr double kTypicalRoughness = 0.45;
constexpr double kRoughnessPenalty = 0.02;
constexpr double kTypicalSpecular = 0.045;
constexpr double kSpecularPenalty = 0.0008;

struct Bin {
  double degrees = 0;  // its lower edge
  std::vector<double> reflectance[3];
  size_t clipped[3] = {0, 0, 0};
  std::array<double, kTriedRoughnesses.size()> factor{};  // sums of D·G/(4·NoL·NoV), flat
  double fresnel = 0;
};

// A bin's mean, for one channel.
struct Sample {
  double reflectance;
  bool at_least;  // clipped: the sample is this bright or brighter
  double weight;
};

void Collect(const PhotographSet& set, const Photograph& photo, size_t stride,
             std::vector<Bin>* bins) {
  const size_t texels = photo.mask.size();
  TexelSvbrdf<double> flat{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, 0.5};
  for (size_t i = stride / 2; i < texels; i += stride) {
    if (photo.mask[i] < 0.5f) continue;
    const int row = static_cast<int>(i / set.plane.width);
    const int column = static_cast<int>(i % set.plane.width);
    const TexelGeometry<double> g = TexelGeometryInView(
        photo.view, set.convention.falloff, set.plane.x_mm(column), set.plane.y_mm(row));
    const double n_dot_l = g.light[2];
    if (n_dot_l < 0.1 || g.camera[2] < 0.1) continue;
    const double degrees = std::acos(std::min(1.0, g.half[2])) * 180.0 / std::numbers::pi;
    const auto edge = std::upper_bound(kBinEdges.begin(), kBinEdges.end(), degrees);
    if (edge == kBinEdges.end()) continue;
    Bin& bin = (*bins)[static_cast<size_t>(edge - kBinEdges.begin()) - 1];
    for (int c = 0; c < 3; ++c) {
      const double radiance = std::max(0.0f, photo.rgb[c * texels + i]);
      bin.reflectance[c].push_back(radiance / std::max(1e-12, g.irradiance[c] * n_dot_l));
      if (photo.ldr && radiance >= kClipped) ++bin.clipped[c];
    }
    for (size_t r = 0; r < kTriedRoughnesses.size(); ++r) {
      flat.roughness = kTriedRoughnesses[r];
      bin.factor[r] += SpecularFactor(flat, g);
    }
    bin.fresnel += g.fresnel;
  }
}

// Means and not medians: on a polished, uneven sample the highlight is a few glints in every bin.
double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

double Quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at + kOffset;
}

// A polished sample that is not quite flat shows its highlight as glints: too few to raise the mean
// much, clipped before they could, and so mistaken for no highlight at all.
bool ShowsGlints(const std::vector<Bin>& bins) {
  std::vector<double> near, far;
  for (const Bin& bin : bins) {
    const std::vector<double>& green = bin.reflectance[1];
    std::vector<double>* side = bin.degrees < kNearDegrees ? &near
                                : bin.degrees >= kFarDegrees && bin.degrees < kFarthestDegrees
                                    ? &far
                                    : nullptr;
    if (side != nullptr) side->insert(side->end(), green.begin(), green.end());
  }
  if (near.size() < 200 || far.size() < 200) return false;
  const double of_near = Quantile(near, kBrightest) / Quantile(near, 0.5);
  const double of_far = Quantile(far, kBrightest) / Quantile(far, 0.5);
  return of_near > kGlints * of_far;
}

// k_d/π that fits the samples beside a known highlight, in relative least squares.
double FitDiffuse(const std::vector<Sample>& samples, const std::vector<double>& highlight) {
  double sum = 0, weight = 0;
  for (size_t b = 0; b < samples.size(); ++b) {
    if (samples[b].at_least) continue;
    const double w = samples[b].weight / std::pow(samples[b].reflectance + kOffset, 2);
    sum += w * (samples[b].reflectance - highlight[b]);
    weight += w;
  }
  return weight > 0 ? std::clamp(sum / weight, 0.0, 1.0 / std::numbers::pi) : 0.0;
}

double LogCost(const std::vector<Sample>& samples, const std::vector<double>& highlight,
               double diffuse) {
  double sum = 0, weight = 0;
  for (size_t b = 0; b < samples.size(); ++b) {
    const double difference =
        std::log(diffuse + highlight[b] + kOffset) - std::log(samples[b].reflectance + kOffset);
    weight += samples[b].weight;
    if (samples[b].at_least && difference > 0) continue;
    sum += samples[b].weight * difference * difference;
  }
  return sum / weight;
}

struct ChannelFit {
  double diffuse = 0, specular = 0;
  double cost = std::numeric_limits<double>::infinity();
};

// Best albedos of one channel for a roughness; factor and fresnel are the bins' means.
ChannelFit FitChannel(const std::vector<Sample>& samples, const std::vector<double>& factor,
                      const std::vector<double>& fresnel) {
  ChannelFit best;
  std::vector<double> highlight(samples.size());
  for (const double specular : kSpecular) {
    for (size_t b = 0; b < samples.size(); ++b) {
      highlight[b] = factor[b] * (specular + (1 - specular) * fresnel[b]);
    }
    const double diffuse = FitDiffuse(samples, highlight);
    const double cost = LogCost(samples, highlight, diffuse) +
                        kSpecularPenalty * std::pow(std::log(specular / kTypicalSpecular), 2);
    if (cost < best.cost) best = {diffuse * std::numbers::pi, specular, cost};
  }
  return best;
}

}  // namespace

GlobalLobes FitGlobalLobes(const PhotographSet& set) {
  const size_t texels = static_cast<size_t>(set.plane.width) * set.plane.height;
  const size_t stride = std::max<size_t>(1, texels * set.photographs.size() / kMaxSamples);
  std::vector<Bin> bins(kBins);
  for (size_t b = 0; b < kBins; ++b) bins[b].degrees = kBinEdges[b];
  for (const Photograph& photo : set.photographs) Collect(set, photo, stride, &bins);
  std::erase_if(bins, [](const Bin& bin) { return bin.reflectance[0].size() < kMinInBin; });
  GlobalLobes best;
  if (bins.empty()) return best;

  std::vector<Sample> samples[3];
  std::vector<double> fresnel;
  for (const Bin& bin : bins) {
    const double count = static_cast<double>(bin.reflectance[0].size());
    fresnel.push_back(bin.fresnel / count);
    for (int c = 0; c < 3; ++c) {
      samples[c].push_back({Mean(bin.reflectance[c]), 2.0 * bin.clipped[c] > count,
                            std::sqrt(std::min(count, kMostWeight))});
    }
  }
  const double most = ShowsGlints(bins) ? kMostPolished : 1.0;
  double best_cost = std::numeric_limits<double>::infinity();
  for (size_t r = 0; r < kTriedRoughnesses.size() && kTriedRoughnesses[r] <= most; ++r) {
    std::vector<double> factor;
    for (const Bin& bin : bins) {
      factor.push_back(bin.factor[r] / static_cast<double>(bin.reflectance[0].size()));
    }
    GlobalLobes lobes;
    lobes.roughness = kTriedRoughnesses[r];
    double cost = kRoughnessPenalty * std::pow(lobes.roughness - kTypicalRoughness, 2);
    for (int c = 0; c < 3; ++c) {
      const ChannelFit fit = FitChannel(samples[c], factor, fresnel);
      lobes.diffuse[c] = std::clamp(fit.diffuse, 0.005, 0.95);
      lobes.specular[c] = fit.specular;
      cost += fit.cost / 3;
    }
    if (cost < best_cost) {
      best_cost = cost;
      best = lobes;
    }
  }
  return best;
}

}  // namespace glint
