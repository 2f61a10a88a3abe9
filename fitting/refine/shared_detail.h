// Detail that a blurred photograph lacks, from sharper ones.
//
// Photographs of one sample mix the same few pictures (albedo, two slopes: calib/registration),
// each in its own proportion. Near a place, the detail of one is therefore a linear combination of
// the others'. With l = log(I + 0.01), B_u the blur that photograph u lacks of v's, T_u that which
// it lacks of the sharpness t aimed at, and H a wide one, coefficients a_u by least squares over 48
// × 48 texels,
//   l_v − H l_v ≈ Σ_u a_u (B_u l_u − H l_u),
// tell what v would show if it were as sharp as t (as pan-sharpening does, with windows of He, Sun
// and Tang, "Guided image filtering", ECCV 2010):
//   l_v + Σ_u a_u (T_u − B_u) l_u.
// u are the sharpest photographs, eight at most. t is the blur of the least sharp of the sharper
// half, which stay as they are. What the combination leaves of v's own coarser detail tells how
// much of the finer is right.
#pragma once

#include <vector>

#include "fitting/photographs/photographs.h"
#include "fitting/refine/refine.h"

namespace glint {

class SharedDetail {
 public:
  SharedDetail() = default;  // of photographs that are all as sharp
  // Photographs are compared by `middle`, rows of them all; nothing is lent where the blur of any
  // was not measured.
  SharedDetail(const PhotographSet& middle, const RefineOptions& options, int threads);

  // Whether photographs, of which no pixels are needed, must be compared at all.
  static bool MayLack(const PhotographSet& views, const RefineOptions& options);

  // Rows above and below on which a texel's detail depends; 0: no photograph lacks any.
  int RowsAbout() const;
  // Sharpens photographs: rows of the sample, in order of those above. Of the `above` first and
  // `below` last of them, where the sample goes on, nothing is right.
  // Sets hidden_variance, and spread_variance to what is left.
  void AddTo(PhotographSet* rows, int threads) const;
  // Of photographs without pixels the latter alone.
  void Describe(PhotographSet* set) const;

 private:
  struct Blurred {
    size_t photograph;
    double hidden_variance;  // once it is sharpened
  };
  double HiddenVariance(const PhotographSet& set, size_t photograph, int threads) const;
  // Returns R² of the combination: 1 less what it leaves of the coarser detail.
  double Sharpen(size_t photograph, int threads, PhotographSet* set) const;

  std::vector<double> variances_;  // of blur by photograph, texels²
  std::vector<size_t> sharper_;    // sharpest first
  std::vector<Blurred> blurred_;
};

}  // namespace glint
