#include "datasets/statistics/material_statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "datasets/statistics/distance.h"
#include "datasets/statistics/fourier.h"
#include "datasets/statistics/moments.h"

namespace glint {
namespace {

constexpr float kSteepestSlope = 4.3f;  // 77°; steeper normals are artefacts of compression
constexpr double kSlowestHeight = 4;    // cycles a side

constexpr std::array<ChannelInfo, kChannels> kChannelInfos = {{{"diffuse", "gamma 2.2", 0, 1},
                                                               {"saturation", "", 0, 1},
                                                               {"f0", "gamma 2.2", 0, 1},
                                                               {"roughness", "", 0, 1},
                                                               {"tilt", "degrees", 0, 80}}};

constexpr std::array<TraitInfo, kTraits> kTraitInfos = {{
    {"diffuse_mean", 0, 1, true},
    {"diffuse_contrast", 0, 1.5, true},
    {"diffuse_skewness", -4, 4, true},
    {"saturation_mean", 0, 1, true},
    {"chroma_spread", 0, 0.1, true},
    {"diffuse_directionality", 0, 1, true},
    {"diffuse_spectral_slope", -5, 0, true},
    {"roughness_mean", 0, 1, true},
    {"roughness_spread", 0, 0.3, true},
    {"roughness_skewness", -4, 4, true},
    {"roughness_spectral_slope", -5, 0, true},
    {"f0_mean", 0, 1, false},
    {"f0_spread", 0, 0.4, false},
    {"tilt_mean_deg", 0, 45, true},
    {"tilt_steep_deg", 0, 80, true},
    {"slope_kurtosis_log10", 0, 2.5, true},
    {"slope_directionality", 0, 1, true},
    {"slope_spectral_slope", -4, 1, true},
    {"height_diffuse", -1, 1, true},
    {"height_roughness", -1, 1, true},
    {"tilt_diffuse", -1, 1, true},
    {"tilt_roughness", -1, 1, true},
    {"diffuse_roughness", -1, 1, true},
    {"fine_diffuse_roughness", -1, 1, true},
    {"fine_height_diffuse", -1, 1, true},
}};

using Plane = std::vector<float>;

struct Planes {
  Plane diffuse, log_diffuse, saturation, red, blue, f0, slope_x, slope_y, tilt;
};

float Luminance(const SvbrdfMaps& maps, int first, size_t i) {
  return 0.2126f * maps.plane(first)[i] + 0.7152f * maps.plane(first + 1)[i] +
         0.0722f * maps.plane(first + 2)[i];
}

float Encoded(float linear) { return std::pow(std::max(linear, 0.0f), 1 / 2.2f); }

void AddColour(const SvbrdfMaps& maps, size_t i, Planes* p) {
  const float r = maps.plane(kDiffuseR)[i], g = maps.plane(kDiffuseG)[i],
              b = maps.plane(kDiffuseB)[i];
  const float luminance = Luminance(maps, kDiffuseR, i);
  p->diffuse.push_back(Encoded(luminance));
  p->log_diffuse.push_back(std::log(luminance + 0.01f));
  const float most = std::max({r, g, b}), least = std::min({r, g, b});
  p->saturation.push_back(most < 1e-3f ? 0 : 1 - least / most);
  const float sum = r + g + b + 0.01f;
  p->red.push_back(r / sum);
  p->blue.push_back(b / sum);
  p->f0.push_back(Luminance(maps, kSpecularR, i));
}

void AddRelief(const SvbrdfMaps& maps, size_t i, Planes* p) {
  const float z = std::max(maps.plane(kNormalZ)[i], 1e-3f);
  float sx = -maps.plane(kNormalX)[i] / z, sy = -maps.plane(kNormalY)[i] / z;
  const float slope = std::hypot(sx, sy);
  const float limit = slope > kSteepestSlope ? kSteepestSlope / slope : 1.0f;
  p->slope_x.push_back(sx * limit);
  p->slope_y.push_back(sy * limit);
  p->tilt.push_back(std::atan(slope * limit) * static_cast<float>(180 / M_PI));
}

Planes PlanesOf(const SvbrdfMaps& maps) {
  Planes p;
  for (size_t i = 0; i < maps.texels(); ++i) {
    AddColour(maps, i, &p);
    AddRelief(maps, i, &p);
  }
  return p;
}

template <typename Values>
std::array<double, kHistogramBins> Histogram(const Values& values, Channel channel) {
  const ChannelInfo& info = InfoOf(channel);
  std::array<double, kHistogramBins> shares{};
  const double one = 1.0 / static_cast<double>(values.size());
  for (const double value : values) {
    const double place = (value - info.low) / (info.high - info.low) * kHistogramBins;
    shares[static_cast<size_t>(std::clamp(place, 0.0, kHistogramBins - 1.0))] += one;
  }
  return shares;
}

double SteepTilt(Plane tilt) {
  const auto at =
      tilt.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(tilt.size()));
  std::nth_element(tilt.begin(), at, tilt.end());
  return *at;
}

double SlopeKurtosis(const Planes& p) {
  const double x = MomentsOf(p.slope_x).kurtosis, y = MomentsOf(p.slope_y).kurtosis;
  return std::log10(std::max((x + y) / 2, 1.0));
}

class Measurement {
 public:
  Measurement(const SvbrdfMaps& maps)
      : side_(maps.width), rough_(maps.plane(kRoughness)), p_(PlanesOf(maps)) {
    Histograms();
    Spectra();
    ColourTraits();
    SurfaceTraits();
    Correlations();
  }
  const MaterialStatistics& result() const { return m_; }

 private:
  void Set(Trait trait, double value) { m_.trait[static_cast<size_t>(trait)] = value; }
  RadialSpectrum& Spectrum(SpectrumOf which) { return m_.spectrum[static_cast<size_t>(which)]; }

  void Histograms() {
    const auto set = [&](Channel channel, const auto& values) {
      m_.histogram[static_cast<size_t>(channel)] = Histogram(values, channel);
    };
    Plane f0(p_.f0.size());
    std::transform(p_.f0.begin(), p_.f0.end(), f0.begin(), Encoded);
    set(Channel::kDiffuse, p_.diffuse);
    set(Channel::kSaturation, p_.saturation);
    set(Channel::kF0, f0);
    set(Channel::kRoughness, rough_);
    set(Channel::kTilt, p_.tilt);
  }

  void Spectra() {
    Spectrum(SpectrumOf::kDiffuse) = PowerSpectrum(p_.diffuse, side_);
    Spectrum(SpectrumOf::kRoughness) = PowerSpectrum(rough_, side_);
    const RadialSpectrum x = PowerSpectrum(p_.slope_x, side_), y = PowerSpectrum(p_.slope_y, side_);
    RadialSpectrum& both = Spectrum(SpectrumOf::kSlope);
    for (size_t band = 0; band < both.size(); ++band) both[band] = x[band] + y[band];
    Set(Trait::kDiffuseSpectralSlope, SpectralSlope(Spectrum(SpectrumOf::kDiffuse)));
    Set(Trait::kRoughnessSpectralSlope, SpectralSlope(Spectrum(SpectrumOf::kRoughness)));
    Set(Trait::kSlopeSpectralSlope, SpectralSlope(both));
  }

  void ColourTraits() {
    double mean = 0;
    for (const float value : p_.diffuse) mean += value;
    Set(Trait::kDiffuseMean, mean / static_cast<double>(p_.diffuse.size()));
    const Moments log = MomentsOf(p_.log_diffuse), f0 = MomentsOf(p_.f0);
    Set(Trait::kDiffuseContrast, log.spread);
    Set(Trait::kDiffuseSkewness, log.skewness);
    Set(Trait::kSaturationMean, MomentsOf(p_.saturation).mean);
    Set(Trait::kChromaSpread, std::hypot(MomentsOf(p_.red).spread, MomentsOf(p_.blue).spread));
    Set(Trait::kDiffuseDirectionality, Directionality(p_.diffuse, side_));
    Set(Trait::kF0Mean, f0.mean);
    Set(Trait::kF0Spread, f0.spread);
  }

  void SurfaceTraits() {
    const Moments rough = MomentsOf(rough_);
    Set(Trait::kRoughnessMean, rough.mean);
    Set(Trait::kRoughnessSpread, rough.spread);
    Set(Trait::kRoughnessSkewness, rough.skewness);
    Set(Trait::kTiltMean, MomentsOf(p_.tilt).mean);
    Set(Trait::kTiltSteep, SteepTilt(p_.tilt));
    Set(Trait::kSlopeKurtosis, SlopeKurtosis(p_));
  }

  void Correlations() {
    const Plane height = HeightFromSlopes(p_.slope_x, p_.slope_y, side_, kSlowestHeight);
    Set(Trait::kSlopeDirectionality, Directionality(height, side_));
    Set(Trait::kHeightDiffuse, Correlation(height, p_.diffuse));
    Set(Trait::kHeightRoughness, Correlation(height, rough_));
    Set(Trait::kTiltDiffuse, Correlation(p_.tilt, p_.diffuse));
    Set(Trait::kTiltRoughness, Correlation(p_.tilt, rough_));
    Set(Trait::kDiffuseRoughness, Correlation(p_.diffuse, rough_));
    Set(Trait::kFineDiffuseRoughness, FineCorrelation(p_.diffuse, rough_, side_));
    Set(Trait::kFineHeightDiffuse, FineCorrelation(height, p_.diffuse, side_));
  }

  int side_;
  std::span<const float> rough_;
  Planes p_;
  MaterialStatistics m_;
};

}  // namespace

const ChannelInfo& InfoOf(Channel channel) { return kChannelInfos[static_cast<size_t>(channel)]; }

const TraitInfo& InfoOf(Trait trait) { return kTraitInfos[static_cast<size_t>(trait)]; }

std::string_view NameOf(SpectrumOf spectrum) {
  constexpr std::array<std::string_view, kSpectra> kNames = {"diffuse", "roughness", "slope"};
  return kNames[static_cast<size_t>(spectrum)];
}

MaterialStatistics MeasureMaterial(const SvbrdfMaps& maps) {
  if (maps.width != maps.height || maps.width < 8 || !IsPowerOfTwo(maps.width)) {
    throw std::invalid_argument("statistics of " + std::to_string(maps.width) + "x" +
                                std::to_string(maps.height) +
                                " texels; maps must be square, their side a power of two from 8");
  }
  return Measurement(maps).result();
}

}  // namespace glint
