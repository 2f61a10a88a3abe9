#include "fitting/view_correction/texel_reduction.h"

#include <Eigen/Cholesky>

#include "base/model/solver.h"

namespace glint {

TexelFollowing::Vector TexelFollowing::After(const Eigen::VectorXd& step) const {
  const Vector half = half_ * step + half_gradient_;
  return factor_.triangularView<Eigen::Lower>().transpose().solve(half);
}

Eigen::RowVectorXd TexelFollowing::ByViewsOf(int variable) const {
  const Vector row = factor_.triangularView<Eigen::Lower>().solve(Vector::Unit(variable).eval());
  return row.transpose() * half_;
}

TexelReduction::TexelReduction(int unknowns, int environment_terms)
    : equations(unknowns),
      environment_terms_(environment_terms),
      products_(kTexelParameters, unknowns),
      texels_(unknowns),
      environment_{OuterProducts(environment_terms), OuterProducts(environment_terms),
                   OuterProducts(environment_terms)} {}

void TexelReduction::Clear() {
  equations.hessian.setZero();
  equations.gradient.setZero();
  texels_.Clear();
  for (OuterProducts& environment : environment_) environment.Clear();
}

void TexelReduction::Begin(const TexelValues& values) {
  double variables[kTexelParameters];
  ToVariables(values, variables);
  TexelValues same;
  ToTexelValues(variables, &same, &by_variable_);
  products_.setZero();
}

void TexelReduction::Add(const BatchResiduals& residuals, int view, int channel, int lane,
                         const std::vector<std::pair<int, double>>& by_views,
                         const Eigen::VectorXd& by_environment) {
  const auto at = [&](BatchResiduals::Row row) { return residuals.at(view, channel, row, lane); };
  const std::pair<int, double> by_texel[] = {
      {DiffuseParameter(channel), at(BatchResiduals::kByDiffuse)},
      {SpecularParameter(channel), at(BatchResiduals::kBySpecular)},
      {kRough, at(BatchResiduals::kByRough)},
      {kSlopeX, at(BatchResiduals::kBySlopeX)},
      {kSlopeY, at(BatchResiduals::kBySlopeY)}};
  for (const auto& [parameter, derivative] : by_texel) {
    const double by = derivative * by_variable_[static_cast<size_t>(parameter)];
    for (const auto& [unknown, by_view] : by_views) products_(parameter, unknown) += by * by_view;
    products_.row(parameter).segment(first_of_environment(channel), environment_terms_) +=
        by * by_environment.transpose();
  }
  equations.Add(at(BatchResiduals::kResidual), by_views);
  if (environment_terms_ > 0) {
    AddEnvironment(channel, at(BatchResiduals::kResidual), by_views, by_environment);
  }
}

// The terms of environment lighting are many and dense.
void TexelReduction::AddEnvironment(int channel, double residual,
                                    const std::vector<std::pair<int, double>>& by_views,
                                    const Eigen::VectorXd& by_environment) {
  const int first = first_of_environment(channel);
  equations.gradient.segment(first, environment_terms_) += residual * by_environment;
  for (const auto& [unknown, by_view] : by_views) {
    equations.hessian.row(unknown).segment(first, environment_terms_) +=
        by_view * by_environment.transpose();
  }
  environment_[static_cast<size_t>(channel)].AddRow() = by_environment.transpose();
}

void TexelReduction::Eliminate(const TexelGram& gram, TexelFollowing* following) {
  TexelFollowing::Square own;
  TexelFollowing::Vector gradient;
  for (int i = 0; i < kTexelParameters; ++i) {
    const size_t a = static_cast<size_t>(i);
    for (int j = i; j < kTexelParameters; ++j) {
      const size_t b = static_cast<size_t>(j);
      own(i, j) = own(j, i) = gram[a][b] * by_variable_[a] * by_variable_[b];
    }
    own(i, i) += constants::kLeastTexelInformation;
    gradient[i] = gram[a][kTexelParameters] * by_variable_[a];
  }
  const Eigen::LLT<TexelFollowing::Square> cholesky(own);
  const TexelFollowing::Square& factor = cholesky.matrixLLT();
  // By forward substitution in place, row by row: Eigen's solver packs its few rows first.
  for (int i = 0; i < kTexelParameters; ++i) {
    for (int j = 0; j < i; ++j) {
      products_.row(i) -= factor(i, j) * products_.row(j);
      gradient[i] -= factor(i, j) * gradient[j];
    }
    products_.row(i) /= factor(i, i);
    gradient[i] /= factor(i, i);
    equations.gradient -= gradient[i] * products_.row(i).transpose();
    texels_.AddRow() = products_.row(i);
  }
  following->Set(factor, products_, gradient);
}

void TexelReduction::Finish() {
  texels_.AddTo(-1, equations.hessian);
  for (int c = 0; c < 3; ++c) {
    const int first = first_of_environment(c);
    environment_[static_cast<size_t>(c)].AddTo(
        1, equations.hessian.block(first, first, environment_terms_, environment_terms_));
  }
}

}  // namespace glint
