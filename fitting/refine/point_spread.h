// The point-spread function of photographs that are coarser than the maps' texels: each pixel sees
// several texels.
//
// The likelihood compares log(y + 0.01) with log(B R + 0.01), y the photograph, R the rendering of
// all texels and B the blur. Texels are solved one by one from a photograph without blur that has
// the same residuals as far as B passes them: with the maps as they are now,
//   log(s + 0.01) = log(R + 0.01) + e,   e ← e + Bᵀ(log(y + 0.01) − log(B R + 0.01) − B e) from 0,
// kDeblurSteps steps of Landweber's iteration (American Journal of Mathematics 73, 1951) whose
// fixed point is the likelihood's; few steps keep noise out of what B hardly passes. B is a
// Gaussian, the same for the whole view, and its own transpose.
#pragma once

#include <span>
#include <vector>

namespace glint {

class PointSpread {
 public:
  // Of a photograph with `pixels_per_texel` pixels along a texel's side (0: not known, none), whose
  // points are spread with a standard deviation of `spread_px` pixels.
  PointSpread(double pixels_per_texel, double spread_px);
  explicit PointSpread(double variance);  // texels²

  // Of the Gaussian along each axis, texels², beyond what a texel averages of itself.
  double variance() const { return variance_; }
  bool none() const { return taps_.empty(); }
  // How far it blurs, texels.
  int reach() const { return none() ? 0 : static_cast<int>(taps_.size() / 2); }

  // B of `planes`, blocks of width × height values; beyond their borders the outermost go on.
  std::vector<float> Blurred(std::span<const float> planes, int width, int height) const;

 private:
  double variance_ = 0;
  std::vector<float> taps_;  // symmetric; sum: 1
};

// s above, 3·H·W values, linear: what `photograph` (`mask`: usable from ½ on; `ldr`: it clips at 1)
// would be without blur, beside `rendering`. Where it clips it stays as it is; a rendering above 1
// counts as 1 there, as the sensor shows it. Masked texels say nothing.
std::vector<float> Deblurred(const PointSpread& spread, std::span<const float> photograph,
                             std::span<const float> mask, bool ldr, std::vector<float> rendering,
                             int width, int height);

}  // namespace glint
