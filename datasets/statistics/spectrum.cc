#include "datasets/statistics/spectrum.h"

#include <algorithm>
#include <cmath>

#include "datasets/statistics/fourier.h"

namespace glint {
namespace {

std::vector<double> HannWindow(int side) {
  std::vector<double> window(static_cast<size_t>(side));
  for (int i = 0; i < side; ++i) {
    // Mean square of a plane's window, (3/8)², is divided out here: 3/8 on either axis.
    window[static_cast<size_t>(i)] =
        (0.5 - 0.5 * std::cos(2 * M_PI * (i + 0.5) / side)) / std::sqrt(3.0 / 8.0);
  }
  return window;
}

int BandOf(double frequency) { return static_cast<int>(std::floor(2 * std::log2(frequency))); }

}  // namespace

double BandFrequency(int band) { return std::exp2((band + 0.5) / 2); }

RadialSpectrum PowerSpectrum(std::span<const float> plane, int side) {
  const std::vector<double> window = HannWindow(side);
  double mean = 0;
  for (const float value : plane) mean += value;
  mean /= static_cast<double>(plane.size());
  std::vector<Complex> wave(plane.size());
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const size_t i = static_cast<size_t>(y) * side + x;
      wave[i] = (plane[i] - mean) * window[static_cast<size_t>(x)] * window[static_cast<size_t>(y)];
    }
  }
  Fourier2d(&wave, side);
  RadialSpectrum power{};
  std::array<double, kSpectrumBands> count{};
  const double scale = 1 / std::pow(static_cast<double>(side), 4);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double frequency = std::hypot(FrequencyOf(x, side), FrequencyOf(y, side));
      if (frequency < 1) continue;
      const int band = BandOf(frequency);
      if (band >= kSpectrumBands) continue;
      power[static_cast<size_t>(band)] +=
          scale * std::norm(wave[static_cast<size_t>(y) * side + x]);
      ++count[static_cast<size_t>(band)];
    }
  }
  for (size_t band = 0; band < power.size(); ++band) power[band] /= std::max(count[band], 1.0);
  return power;
}

double SpectralSlope(const RadialSpectrum& spectrum) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int band = 0; band < kSpectrumBands; ++band) {
    const double frequency = BandFrequency(band), power = spectrum[static_cast<size_t>(band)];
    if (frequency < 4 || frequency > 90 || power <= 0) continue;
    const double x = std::log10(frequency), y = std::log10(power);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return n < 3 ? 0 : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::vector<float> HeightFromSlopes(std::span<const float> slope_x, std::span<const float> slope_y,
                                    int side, double lowest) {
  std::vector<Complex> wave_x(slope_x.begin(), slope_x.end());
  std::vector<Complex> wave_y(slope_y.begin(), slope_y.end());
  Fourier2d(&wave_x, side);
  Fourier2d(&wave_y, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const size_t i = static_cast<size_t>(y) * side + x;
      const double fx = FrequencyOf(x, side), fy = -FrequencyOf(y, side);  // rows run downward
      const double square = fx * fx + fy * fy;
      const Complex along = fx * wave_x[i] + fy * wave_y[i];
      const Complex per_wave(0, -side / (2 * M_PI));
      wave_x[i] = square < lowest * lowest || square == 0 ? 0.0 : per_wave * along / square;
    }
  }
  InverseFourier2d(&wave_x, side);
  std::vector<float> height(wave_x.size());
  std::transform(wave_x.begin(), wave_x.end(), height.begin(),
                 [](const Complex& value) { return static_cast<float>(value.real()); });
  return height;
}

}  // namespace glint
