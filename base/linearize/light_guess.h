// A first guess of the flash's power where nobody measured it.
#pragma once

#include <vector>

#include "base/formats/rectified_set.h"

namespace glint {

// Watches rectified views go by and ends with the power that makes the sample's diffuse albedo
// plausible: with q = π·L / (irradiance of a light of power 1), the albedo of a Lambertian texel is
// q / power. Per point of a coarse grid the median q of the views counts (the lower one of two),
// which leaves highlights and shadows out; the power then puts the median albedo at 0.3, or lower
// where bright texels would pass 0.95.
class LightGuess {
 public:
  LightGuess(const SamplePlane& plane, LightFalloff falloff);

  // The next view; the grid is all that is kept of it.
  void Add(const RectifiedImage& image);
  // The same by rows, from the top.
  void BeginView();
  void AddRows(const RectifiedImage& rows);

  // `views` in the order in which they were added; their positions and exposures are used, not
  // their light_rgb. 0 when no view had a usable texel that is not black.
  double Power(const std::vector<View>& views) const;

 private:
  size_t points() const { return columns_.size() * rows_.size(); }

  SamplePlane plane_;
  LightFalloff falloff_;
  std::vector<int> columns_, rows_;           // of the grid's points
  std::vector<std::vector<float>> radiance_;  // per view and point; negative: not usable
  int next_row_ = 0;                          // of the last view
};

// Gives the views the power that `guess` ends with, white; without one they stay as they are.
// Ambient light is in the views' own units and stays.
void GiveLight(const LightGuess& guess, RectifiedSet* set);

}  // namespace glint
