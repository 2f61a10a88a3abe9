// Power spectra and relief, both by Fourier transform of square planes (side a power of two).
#pragma once

#include <array>
#include <span>
#include <vector>

namespace glint {

// Half octaves from 1 cycle a side: band b holds the radial frequencies 2^(b/2) ≤ f < 2^((b+1)/2).
// At 256 texels a side the last band ends at the shortest wave along an axis, two texels.
inline constexpr int kSpectrumBands = 14;
// Middle of a band, in cycles a side.
double BandFrequency(int band);

using RadialSpectrum = std::array<double, kSpectrumBands>;

// Mean power of a coefficient in each band, of the plane less its mean under a Hann window that is
// scaled to keep the variance: the sum over all coefficients is about the variance. Bands beyond
// the plane's own shortest wave are 0.
RadialSpectrum PowerSpectrum(std::span<const float> plane, int side);

// Slope of log10 power over log10 frequency between 4 and 90 cycles a side, least squares: −2 for
// surfaces whose detail looks the same at every scale, 0 for white noise.
double SpectralSlope(const RadialSpectrum& spectrum);

// Height, in texels, whose slopes are nearest to the given ones (tangents, x right, y up), periodic
// (Frankot and Chellappa 1988), without what is slower than `lowest` cycles a side.
std::vector<float> HeightFromSlopes(std::span<const float> slope_x, std::span<const float> slope_y,
                                    int side, double lowest);

}  // namespace glint
