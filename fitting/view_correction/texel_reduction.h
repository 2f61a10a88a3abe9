// Normal equations of the views from which texels are eliminated, one texel after the other: their
// Schur complement (Kaufman's form of variable projection).
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "fitting/texel/texel_batch.h"
#include "fitting/texel/texel_parameters.h"
#include "fitting/view_correction/normal_equations.h"
#include "fitting/view_correction/outer_products.h"

namespace glint {

// How one texel follows the views. With its own normal equations L·Lᵀ, their products P with the
// views' unknowns x and their gradient g, −∂u/∂x = L⁻ᵀ·(L⁻¹·P) of the solver's variables u.
class TexelFollowing {
 public:
  using Vector = Eigen::Matrix<double, kTexelParameters, 1>;
  using Square = Eigen::Matrix<double, kTexelParameters, kTexelParameters>;
  using ByViews = Eigen::Matrix<double, kTexelParameters, Eigen::Dynamic, Eigen::RowMajor>;

  void Set(const Square& factor, const ByViews& half, const Vector& half_gradient) {
    factor_ = factor;
    half_ = half;
    half_gradient_ = half_gradient;
  }

  // −Δu after `step` of the views, its own step included.
  Vector After(const Eigen::VectorXd& step) const;
  // Of one variable.
  Eigen::RowVectorXd ByViewsOf(int variable) const;

 private:
  Square factor_;  // L, its lower triangle
  ByViews half_;
  Vector half_gradient_;  // L⁻¹·g
};

class TexelReduction {
 public:
  // `environment_terms`: of a channel; the environment's unknowns come first of all, channel by
  // channel.
  TexelReduction(int unknowns, int environment_terms);

  // To begin anew.
  void Clear();
  // A texel with these values.
  void Begin(const TexelValues& values);
  // One residual of it, and its derivatives by a few unknowns and by the channel's terms of the
  // environment lighting (of no size without these); those by the texel's values are in
  // `residuals`.
  void Add(const BatchResiduals& residuals, int view, int channel, int lane,
           const std::vector<std::pair<int, double>>& by_views,
           const Eigen::VectorXd& by_environment);
  // Takes the texel out; `gram`: its own products.
  void Eliminate(const TexelGram& gram, TexelFollowing* following);
  // After the last texel. Only the lower triangle of `equations` is complete.
  void Finish();

  NormalEquations equations;

 private:
  void AddEnvironment(int channel, double residual,
                      const std::vector<std::pair<int, double>>& by_views,
                      const Eigen::VectorXd& by_environment);
  int first_of_environment(int channel) const { return environment_terms_ * channel; }

  int environment_terms_;
  TexelValues by_variable_{};  // ∂value/∂(the solver's variable): a value at its bound stays
  TexelFollowing::ByViews products_;
  OuterProducts texels_;
  std::array<OuterProducts, 3> environment_;  // by channel
};

}  // namespace glint
