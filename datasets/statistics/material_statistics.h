// What one material's maps look like in numbers.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "datasets/statistics/spectrum.h"

namespace glint {

// Channels whose texels are counted into histograms.
enum class Channel { kDiffuse, kSaturation, kF0, kRoughness, kTilt, kCount };
inline constexpr int kChannels = static_cast<int>(Channel::kCount);
inline constexpr int kHistogramBins = 64;

struct ChannelInfo {
  std::string_view name, unit;
  double low, high;  // of the histogram; texels beyond count into its ends
};
// Diffuse and F0 are luminances in gamma 2.2, so that dark values are told apart; tilt is the
// normal's angle from the top in degrees.
const ChannelInfo& InfoOf(Channel channel);

// Planes whose power spectra are compared. Diffuse is luminance in gamma 2.2.
enum class SpectrumOf { kDiffuse, kRoughness, kSlope, kCount };
inline constexpr int kSpectra = static_cast<int>(SpectrumOf::kCount);
std::string_view NameOf(SpectrumOf spectrum);

// One number a material.
enum class Trait {
  kDiffuseMean,
  kDiffuseContrast,  // standard deviation of ln(luminance + .01)
  kDiffuseSkewness,
  kSaturationMean,
  kChromaSpread,  // standard deviation of r/(r+g+b) and b/(r+g+b) together
  kDiffuseDirectionality,
  kDiffuseSpectralSlope,
  kRoughnessMean,
  kRoughnessSpread,
  kRoughnessSkewness,
  kRoughnessSpectralSlope,
  kF0Mean,
  kF0Spread,
  kTiltMean,       // degrees
  kTiltSteep,      // degrees: 99 % of texels lie flatter
  kSlopeKurtosis,  // log10, of both components; .48 is a normal distribution's
  kSlopeDirectionality,
  kSlopeSpectralSlope,
  kHeightDiffuse,  // correlations; the height is the normals', without what is slower than 4 cycles
  kHeightRoughness,
  kTiltDiffuse,
  kTiltRoughness,
  kDiffuseRoughness,
  kFineDiffuseRoughness,  // of details as fine as texels
  kFineHeightDiffuse,
  kCount
};
inline constexpr int kTraits = static_cast<int>(Trait::kCount);

struct TraitInfo {
  std::string_view name;
  double low, high;  // range of the picture's axis
  bool judged;       // enters the mean distance; F0 does not: no data set measured it
};
const TraitInfo& InfoOf(Trait trait);

struct MaterialStatistics {
  std::array<std::array<double, kHistogramBins>, kChannels> histogram{};  // shares of texels
  std::array<RadialSpectrum, kSpectra> spectrum{};
  std::array<double, kTraits> trait{};  // NaN: undefined, such as a flat map's correlation

  double operator[](Trait t) const { return trait[static_cast<size_t>(t)]; }
};

// `maps` is square with a power of two of texels a side, at least 8; throws std::invalid_argument
// otherwise.
MaterialStatistics MeasureMaterial(const SvbrdfMaps& maps);

}  // namespace glint
