// How a rendering looks beside its photograph: what a person sees of the two that a mean error does
// not tell apart. A rendering that is everywhere a little too dark, one that is blurred and one
// whose highlights are in the wrong place may all have one log-L1.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "base/formats/rectified_set.h"

namespace glint {

// Of two pictures as a screen shows them: linear radiance clipped to [0, 1], gamma 2.2, rounded to
// 8 bits, and for figures in radiance decoded again. A figure that cannot be told is NaN: each says
// when. Bands are those of a picture 256 texels wide; another has them in proportion, so that
// contrast and correlation of one photograph at two sizes are about the same. Names and meanings,
// for files and tables: looks_figures.h.
struct Looks {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  // log-L1 (eq. 2 of Gao et al. 2019) after the best factor of each channel, which is the median of
  // the residuals: the exposure of a photograph that was not fitted is not known. Over the texels
  // where the photograph's brightest channel is below 252 of 255. Unknown where there are none.
  double free = kUnknown;
  // Standard deviation of log luminance in a band of detail, the rendering's over the photograph's:
  // below 1 blurred or flat, above 1 noisy or harsh. Luminance is the mean of the channels' log
  // (I + 0.01); the bands are differences of Gaussian blurs and hold detail of 1 to 2 texels (and
  // finer), 2 to 4, 4 to 8 and 8 to 16 (sigma 0, 1, 2, 4, 8). Unknown where the photograph has no
  // detail in the band: of a constant picture, of the finest bands of one less than some 60 texels
  // wide.
  std::array<double, 4> contrast{kUnknown, kUnknown, kUnknown, kUnknown};
  // Correlation of the first three bands, at most 1: whether the detail is the photograph's. Of
  // pictures averaged to 256 texels across if they are larger; the largest over shifts by at most
  // three texels, so that it does not judge registration. Pictures less than 34 texels along a side
  // are shifted by less, those below 16 not known; nor where the photograph has no detail.
  std::array<double, 3> correlation{kUnknown, kUnknown, kUnknown};
  // Structural similarity of the grey pictures (Wang et al. 2004; Gaussian window of 11 × 11 and
  // sigma 1.5, in the picture's own texels), at most 1.
  double ssim = kUnknown;
  // Mean luminance (of clipped radiance, mean of the channels) of the 2 % of the texels where the
  // photograph is brightest, the rendering's over the photograph's. Unknown where it is black.
  double highlight = kUnknown;
};

// `rendered`: planar 3·H·W as the photograph, linear. `ldr`: the photograph clips at radiance 1.
// What the photograph says nothing of (mask below 0.5, and not for being clipped, as ReachesLimit
// tells) does not count in `free`; the other figures need whole pictures and have the rendering in
// its place, in both. All are unknown when it says nothing anywhere. Throws std::invalid_argument
// when sizes differ.
Looks CompareLooks(std::span<const float> rendered, const RectifiedImage& photograph, bool ldr);

}  // namespace glint
