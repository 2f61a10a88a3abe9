#include "datasets/statistics/comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/statistics/quantile.h"
#include "datasets/statistics/distance.h"

namespace glint {
namespace {

constexpr double kShares[3] = {0.1, 0.5, 0.9};

// Middle of the bin in which the cumulative share passes.
double HistogramQuantile(std::span<const double> histogram, const ChannelInfo& info, double share) {
  double sum = 0;
  size_t bin = 0;
  while (bin + 1 < histogram.size() && (sum += histogram[bin]) < share) ++bin;
  return info.low + (info.high - info.low) * (static_cast<double>(bin) + 0.5) / kHistogramBins;
}

Distance CompareChannel(const Population& real, const Population& generated, Channel channel) {
  const ChannelInfo& info = InfoOf(channel);
  const auto a = real.MeanHistogram(channel), b = generated.MeanHistogram(channel);
  Distance d{"histogram", std::string(info.name)};
  d.ks = HistogramKolmogorovSmirnov(a, b);
  d.wasserstein = HistogramWasserstein(a, b, (info.high - info.low) / kHistogramBins);
  d.judged = channel != Channel::kF0;
  for (int q = 0; q < 3; ++q) {
    d.quantiles[0][q] = HistogramQuantile(a, info, kShares[q]);
    d.quantiles[1][q] = HistogramQuantile(b, info, kShares[q]);
  }
  return d;
}

void SetQuantiles(const std::vector<double>& a, const std::vector<double>& b, Distance* d) {
  for (int q = 0; q < 3; ++q) {
    d->quantiles[0][q] = Quantile(a, kShares[q]);
    d->quantiles[1][q] = Quantile(b, kShares[q]);
  }
}

Distance CompareSpectrum(const Population& real, const Population& generated, SpectrumOf spectrum) {
  Distance d{"spectrum", std::string(NameOf(spectrum))};
  for (int band = 0; band < kSpectrumBands; ++band) {
    const auto a = real.LogPower(spectrum, band), b = generated.LogPower(spectrum, band);
    d.ks += KolmogorovSmirnov(a, b) / kSpectrumBands;
    d.wasserstein += Wasserstein(a, b) / kSpectrumBands;
    if (band == kSpectrumBands / 2) SetQuantiles(a, b, &d);
  }
  d.expected_ks = ExpectedKolmogorovSmirnov(real.materials.size(), generated.materials.size());
  return d;
}

Distance CompareTrait(const Population& real, const Population& generated, Trait trait) {
  const auto a = real.Trait(trait), b = generated.Trait(trait);
  Distance d{"trait", std::string(InfoOf(trait).name)};
  d.ks = KolmogorovSmirnov(a, b);
  d.wasserstein = Wasserstein(a, b);
  d.expected_ks = ExpectedKolmogorovSmirnov(a.size(), b.size());
  d.judged = InfoOf(trait).judged;
  SetQuantiles(a, b, &d);
  return d;
}

}  // namespace

double Comparison::MeanDistance(const std::string& group) const {
  double sum = 0;
  int count = 0;
  for (const Distance& d : distances) {
    if (!d.judged || (!group.empty() && d.group != group)) continue;
    sum += d.ks;
    ++count;
  }
  return count == 0 ? 0 : sum / count;
}

std::string Comparison::BriefReport() const {
  std::string text = fmt::format(
      "{} real and {} generated materials; Kolmogorov-Smirnov distances: mean {:.3f} (histograms "
      "{:.3f}, spectra {:.3f}, traits {:.3f}); similar populations of these sizes show {:.3f}\n",
      real.materials.size(), generated.materials.size(), MeanDistance(""),
      MeanDistance("histogram"), MeanDistance("spectrum"), MeanDistance("trait"),
      ExpectedKolmogorovSmirnov(real.materials.size(), generated.materials.size()));
  text += fmt::format("{:<34} {:>5} {:>8}   {:<25} {}\n", "", "KS", "W1", "real 10/50/90 %",
                      "generated");
  for (const Distance& d : distances) {
    text += fmt::format("{:<34} {:5.3f} {:8.4f}  ", d.group + " " + d.name, d.ks, d.wasserstein);
    for (const auto& q : d.quantiles)
      text += fmt::format(" {:7.3f} {:7.3f} {:7.3f} ", q[0], q[1], q[2]);
    text += d.judged ? "\n" : " (not judged)\n";
  }
  return text;
}

Comparison Compare(Population real, Population generated) {
  Comparison c;
  for (int i = 0; i < kChannels; ++i) {
    c.distances.push_back(CompareChannel(real, generated, static_cast<Channel>(i)));
  }
  for (int i = 0; i < kSpectra; ++i) {
    c.distances.push_back(CompareSpectrum(real, generated, static_cast<SpectrumOf>(i)));
  }
  for (int i = 0; i < kTraits; ++i) {
    c.distances.push_back(CompareTrait(real, generated, static_cast<Trait>(i)));
  }
  c.real = std::move(real);
  c.generated = std::move(generated);
  return c;
}

}  // namespace glint
