// How wrong held-out views were predicted, and how much better one prediction is than another.
//
// The second is measured rather than assumed. With S_a, S_b the sums of squares of two, the
// logarithm L = log S_a − log S_b has the variance that its parts show: those of the held-out
// photographs, which may be others next time, and those of places on the sample, since texels of
// like half vectors err alike,
//   v = Σ_folds (s_a/S_a − s_b/S_b)² + Σ_places (s_a/S_a − s_b/S_b)².
// What both predict alike tells nothing, and where a few highlights make nearly all of the error, a
// few highlights decide. The energy of the worse one is 2 L²/v, as of a composite likelihood with
// Godambe's information for Fisher's (Pauli, Racugno and Ventura 2011): of two points δ apart, one
// of them the best, L = ½Hδ² and v = Jδ², so that ½ (H²/J) δ² = 2 L²/v.
//
// How bright a held-out photograph was in all is not what maps could know where exposures are not
// known: they are compared after each photograph's best factor.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint {

// log(R + 0.01) − log(I + 0.01) of one texel, by view and channel, times the square root of the
// view's weight; nothing: the view does not show it.
using ViewDifferences = std::vector<std::optional<std::array<float, 3>>>;

// Squared residuals g² (texel/batch_kernel.h) of these, of each texel, summed over views and
// channels. `free_exposures`: after the factor on each view's photograph that makes its sum least.
std::vector<double> SquaresOf(std::span<const ViewDifferences> texels, double robust_scale,
                              bool free_exposures);

// Sums of squared residuals g². Two that are compared have the same places, and their folds in the
// same order; one may have fewer, where its prediction was not finished.
class HeldOutErrors {
 public:
  explicit HeldOutErrors(size_t places) : places_(places) {}

  void BeginFold() { folds_.push_back({0.0, std::vector<double>(places_)}); }
  // Of the fold begun last.
  void Add(size_t place, double squares);

  size_t folds() const { return folds_.size(); }
  double sum() const { return SumOf(folds()); }
  // The negative logarithm of how probable this is when `other` is one; below 0 where this is the
  // better one, 0 where nothing tells them apart. By the folds that both have, from the first on.
  double EnergyAgainst(const HeldOutErrors& other) const;

 private:
  struct Fold {
    double sum = 0;
    std::vector<double> by_place;
  };
  // Of the first `folds`.
  double SumOf(size_t folds) const;
  std::vector<double> ByPlace(size_t folds) const;

  size_t places_;
  std::vector<Fold> folds_;
};

}  // namespace glint
