// By how much each photograph deviates from what is said of it: the exposure or the flash's power,
// and the place of its flash. Captures that nobody calibrated state one exposure for all and
// positions to a degree or so; a telephone's flash and its exposure vary by some per cent.
//
// A flash elsewhere shades a matte sample a little from side to side, and so do vignetting and the
// flash's beam, unlike in every view. So a gradient of each view's shading is unknown as well; it
// is not applied, and leaves the flash's place to the highlights.
//
// What all photographs share of their light (shared_light.h) is found with them.
//
// Lamps that are brighter to one side and a sample that is tilted look alike, but for gloss. Where
// each photograph has a lamp of its own (LampsExpected), their strengths have a gradient over the
// directions with a wide prior, and the sample is expected to be level in the mean.
//
// Each deviation is Gaussian about 0 with a spread estimated of the capture (MacKay 1992, as the
// residuals' variance is). The deviations are the most probable ones with all texels eliminated:
// Newton steps on the marginal likelihood, whose information is the Schur complement of the texels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "fitting/texel/texel_batch.h"
#include "fitting/view_correction/deviating_view.h"
#include "fitting/view_correction/shared_light.h"

namespace glint {

// Of one texel and one view that shows it: sums over channels of products of the residuals'
// derivatives by the view's deviations. In single precision, as the residuals are: there are 2,048
// texels times the views of them.
struct DeviationProducts {
  using Row = std::array<float, kViewDeviations>;
  int view = 0;
  std::array<float, kSharedLightValues> by_shared{};  // DeviationsByShared()
  std::array<Row, kViewDeviations> squared{};
  Row by_residual{};
  std::array<std::array<float, kTexelParameters>, kViewDeviations> by_values{};
};

using UnknownDeviations = std::array<bool, kViewDeviations>;

// Of a lane's texel in one view. `nudged`: for each deviation in turn, with views that are a step
// further; of those that are not `unknown` anything. Which view it is, and `by_shared`, is left to
// the caller.
DeviationProducts ProductsOf(const BatchResiduals& residuals,
                             std::span<const BatchResiduals> nudged,
                             const UnknownDeviations& unknown, int view, int lane);

// What one texel tells of the views.
struct TexelOfViews {
  std::array<double, 2> place{};    // on the sample, −1 … 1 along each axis
  std::array<double, 2> slope{};    // of its normal, as solved
  const double* inverse = nullptr;  // (JᵀJ + prior)⁻¹, row-major
  const std::vector<DeviationProducts>* products = nullptr;
};

// The prior of lamps that differ from photograph to photograph.
struct LampsExpected {
  // By view: x and y of the unit vector to its light. Empty: all have one light.
  std::vector<std::array<double, 2>> directions;
  // Standard deviations of the gradient of log exposure by those, and of the sample's mean slope.
  double gradient = 0, level = 0;
};

class ViewDeviations {
 public:
  // `expected`: standard deviations before anything is seen; 0: that one is as said.
  ViewDeviations(int views, const DeviationValues& expected,
                 const SharedLightValues& expected_shared, LampsExpected lamps = {});

  bool any() const { return any_; }
  // What derivatives are wanted by: what is unknown, and not held, of single views or of what all
  // share.
  UnknownDeviations unknown() const;
  // Whether the photographs' curve is unknown, and moves.
  bool finds_curve() const;
  void HoldCurve(bool hold);  // or let it go, as if for the first time
  // One step. `information`: what a squared residual of these texels is worth, 1 / variance. The
  // same for any number of threads.
  void Update(std::span<const TexelOfViews> texels, double information, int threads);

  const std::vector<DeviationValues>& values() const { return values_; }
  const SharedLightValues& shared() const { return shared_; }
  const DeviationValues& spreads() const { return spreads_; }

 private:
  // The prior precision of all views' log exposures.
  Eigen::MatrixXd ExposurePrecision() const;
  // Those of shared values that move.
  SharedLightValues ExpectedOfShared() const;
  double CurveStep(size_t shared, double newton);
  void UpdateSpreads(const std::vector<DeviationValues>& variances);

  DeviationValues expected_, spreads_;
  SharedLightValues expected_shared_, shared_{};
  LampsExpected lamps_;
  std::vector<DeviationValues> values_;
  SharedLightValues last_step_{};  // of the curve's; 0: none yet
  bool any_ = false, curve_held_ = false;
};

}  // namespace glint
