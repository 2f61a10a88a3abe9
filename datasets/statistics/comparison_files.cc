#include "datasets/statistics/comparison_files.h"

#include <fmt/format.h>

#include <cmath>

#include "base/files/files.h"
#include "base/images/image.h"
#include "base/statistics/quantile.h"
#include "datasets/statistics/comparison_picture.h"
#include "datasets/statistics/distance.h"

namespace glint {
namespace {

// Six digits are more than the statistics hold, and keep the file readable.
double Rounded(double value) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const double scale = std::pow(10, 5 - std::floor(std::log10(std::fabs(value))));
  return std::round(value * scale) / scale;
}

Json DistanceJson(const Distance& d) {
  Json quantiles[2];
  for (int side = 0; side < 2; ++side) {
    for (const double q : d.quantiles[side]) quantiles[side].push_back(Rounded(q));
  }
  return {{"group", d.group},
          {"name", d.name},
          {"ks", Rounded(d.ks)},
          {"expected_ks_of_alike", Rounded(d.expected_ks)},
          {"wasserstein", Rounded(d.wasserstein)},
          {"judged", d.judged},
          {"real_10_50_90", quantiles[0]},
          {"generated_10_50_90", quantiles[1]}};
}

Json HistogramsJson(const Population& population) {
  Json all;
  for (int i = 0; i < kChannels; ++i) {
    Json& bins = all[std::string(InfoOf(static_cast<Channel>(i)).name)];
    for (const double share : population.MeanHistogram(static_cast<Channel>(i))) {
      bins.push_back(Rounded(share));
    }
  }
  return all;
}

Json SpectraJson(const Population& population) {
  Json all;
  for (int i = 0; i < kSpectra; ++i) {
    Json& bands = all[std::string(NameOf(static_cast<SpectrumOf>(i)))];
    for (int band = 0; band < kSpectrumBands; ++band) {
      const auto powers = population.LogPower(static_cast<SpectrumOf>(i), band);
      bands.push_back({Rounded(Quantile(powers, 0.1)), Rounded(Quantile(powers, 0.5)),
                       Rounded(Quantile(powers, 0.9))});
    }
  }
  return all;
}

Json PopulationJson(const Population& population) {
  return {{"name", population.name},
          {"materials", population.materials.size()},
          {"histograms", HistogramsJson(population)},
          {"log10_power_10_50_90", SpectraJson(population)}};
}

void AddRows(const std::string& side, const Population& population, std::string* csv) {
  for (size_t i = 0; i < population.materials.size(); ++i) {
    *csv += side + "," + population.materials[i];
    for (const double value : population.statistics[i].trait) {
      *csv += std::isnan(value) ? "," : fmt::format(",{:.6g}", value);
    }
    *csv += "\n";
  }
}

}  // namespace

Json ComparisonJson(const Comparison& comparison) {
  Json json;
  for (const char* group : {"", "histogram", "spectrum", "trait"}) {
    json["mean_ks"][*group == 0 ? "all" : group] = Rounded(comparison.MeanDistance(group));
  }
  for (const Distance& d : comparison.distances) json["distances"].push_back(DistanceJson(d));
  for (int band = 0; band < kSpectrumBands; ++band) {
    json["band_cycles"].push_back(Rounded(BandFrequency(band)));
  }
  json["real"] = PopulationJson(comparison.real);
  json["generated"] = PopulationJson(comparison.generated);
  return json;
}

std::string TraitCsv(const Comparison& comparison) {
  std::string csv = "side,material";
  for (int i = 0; i < kTraits; ++i) csv += "," + std::string(InfoOf(static_cast<Trait>(i)).name);
  csv += "\n";
  AddRows("real", comparison.real, &csv);
  AddRows("generated", comparison.generated, &csv);
  return csv;
}

void WriteComparison(const std::filesystem::path& folder, const Comparison& comparison) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  WriteFileAtomically(folder / "statistics.json", ComparisonJson(comparison).dump(1) + "\n");
  WriteFileAtomically(folder / "statistics.csv", TraitCsv(comparison));
  WritePng(folder / "statistics.png", DrawComparison(comparison));
}

}  // namespace glint
