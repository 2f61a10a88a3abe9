#include "fitting/texel/texel_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fitting/texel/texel_lobes.inl"
#include "fitting/texel/texel_vector.inl"

namespace glint {
namespace {

[[gnu::always_inline]] inline void EvaluateResiduals(const KernelOptions& options,
                                                     const TexelObservations& observations,
                                                     const TexelValues& texel, int channel,
                                                     KernelRows* rows) {
  const double specular = texel[SpecularParameter(channel)];
  const DiffuseTerms<double> diffuse =
      EvaluateDiffuse(texel[DiffuseParameter(channel)], specular,
                      options.diffuse_weight == DiffuseWeight::kOneMinusSpecular);
  const double inverse_scale = 1.0 / options.robust_scale;

  const double* __restrict fresnel = observations.plane(TexelObservations::kFresnel);
  const double* __restrict irradiance =
      observations.plane(TexelObservations::kIrradiance + channel);
  const double* __restrict ambient = observations.plane(TexelObservations::kAmbient + channel);
  const double* __restrict ambient_specular =
      observations.plane(TexelObservations::kAmbientSpecular + channel);
  const double* __restrict target = observations.plane(TexelObservations::kLogTarget + channel);
  const double* __restrict ceiling = observations.plane(TexelObservations::kCeiling + channel);
  const double* __restrict weight = observations.plane(TexelObservations::kWeight);
  const double* __restrict nl = rows->lobe(kNormalLight);
  const double* __restrict nl_x = rows->lobe(kByXNormalLight);
  const double* __restrict nl_y = rows->lobe(kByYNormalLight);
  const double* __restrict s = rows->lobe(kLobe);
  const double* __restrict s_x = rows->lobe(kByXLobe);
  const double* __restrict s_y = rows->lobe(kByYLobe);
  const double* __restrict s_r = rows->lobe(kByRLobe);
  double* __restrict by_x = rows->row(channel, KernelRows::kBySlopeX);
  double* __restrict by_y = rows->row(channel, KernelRows::kBySlopeY);
  double* __restrict by_r = rows->row(channel, KernelRows::kByRough);
  double* __restrict by_d = rows->row(channel, KernelRows::kByDiffuse);
  double* __restrict by_s = rows->row(channel, KernelRows::kBySpecular);
  double* __restrict residual = rows->row(channel, KernelRows::kResidual);
  const int views = observations.padded_views();
#pragma GCC ivdep
  for (int v = 0; v < views; ++v) {
    const ChannelTerms<double> terms = EvaluateChannel(diffuse, specular, fresnel[v], nl[v], s[v]);
    const double offset_radiance = irradiance[v] * terms.reflected + ambient[v] * diffuse.value +
                                   ambient_specular[v] * specular * kInversePi + kLogOffset;

    const double free = Log(offset_radiance) - target[v];
    const double error = free < ceiling[v] ? free : ceiling[v];
    const double on = free < ceiling[v] ? 1.0 : 0.0;
    const double scaled = error * inverse_scale;
    const double root = std::sqrt(1.0 + scaled * scaled);
    // One division serves 2/(1 + root) and 1/(root·(R + 0.01)).
    const double above = 1.0 + root, below = root * offset_radiance;
    const double inverse = 1.0 / (above * below);
    const double shrink = std::sqrt(2.0 * below * inverse);
    residual[v] = weight[v] * (error * shrink);
    // g'(e) = 1/(root·shrink) = shrink·(1 + root)/(2·root), and ∂e/∂R = 1/(R + 0.01)
    const double chain = weight[v] * on * (0.5 * shrink * above * above * inverse);

    const ChannelSlopes<double> by = DifferentiateChannel(
        diffuse, terms, fresnel[v], nl[v], s[v], irradiance[v], ambient[v], ambient_specular[v]);
    by_x[v] = chain * (by.by_n_dot_l * nl_x[v] + by.by_lobe * s_x[v]);
    by_y[v] = chain * (by.by_n_dot_l * nl_y[v] + by.by_lobe * s_y[v]);
    by_r[v] = chain * (by.by_lobe * s_r[v]);
    by_d[v] = chain * by.by_diffuse;
    by_s[v] = chain * by.by_specular;
  }
}

// Products of the rows that one channel has for itself with all its rows, and of the others among
// themselves, which add up over the channels. Upper triangles, row by row.
constexpr int kOwnRows = 2;  // by the channel's diffuse and specular albedo
constexpr int kOwnProducts = 6 + 5;
constexpr int kSharedProducts = 4 + 3 + 2 + 1;
struct Products {
  double own[3][kOwnProducts];
  double shared[kSharedProducts];
};

[[gnu::always_inline]] inline void AccumulateChannel(const KernelRows& rows, int channel, int views,
                                                     double own_sums[kOwnProducts],
                                                     Lanes shared[kSharedProducts]) {
  constexpr int kRows = KernelRows::kRows;
  Lanes own[kOwnProducts];
  for (auto& sum : own) sum = Lanes{};
  const double* base = rows.row(channel, 0);
  const std::ptrdiff_t stride = rows.row(channel, 1) - base;
  for (int v = 0; v < views; v += kLanes) {
    Lanes values[kRows];
#pragma GCC unroll 6
    for (int a = 0; a < kRows; ++a) {
      values[a] = *reinterpret_cast<const Lanes*>(base + a * stride + v);
    }
    int next = 0;
#pragma GCC unroll 6
    for (int a = 0; a < kRows; ++a) {
      if (a == kOwnRows) next = 0;
#pragma GCC unroll 6
      for (int b = a; b < kRows; ++b) {
        (a < kOwnRows ? own : shared)[next++] += values[a] * values[b];
      }
    }
  }
  for (int i = 0; i < kOwnProducts; ++i) own_sums[i] = Sum(own[i]);
}

// The rows stand in the order of the parameters.
void FillGram(const Products& products, TexelGram* gram) {
  for (auto& row : *gram) row.fill(0.0);
  for (int c = 0; c < 3; ++c) {
    const double* from = products.own[c];
    const int d = DiffuseParameter(c), s = SpecularParameter(c);
    (*gram)[d][d] = from[0];
    (*gram)[d][s] = from[1];
    std::copy_n(from + 2, kGramSize - kRough, (*gram)[d].begin() + kRough);
    (*gram)[s][s] = from[6];
    std::copy_n(from + 7, kGramSize - kRough, (*gram)[s].begin() + kRough);
  }
  const double* from = products.shared;
  for (int a = kRough; a < kGramSize; from += kGramSize - a, ++a) {
    std::copy_n(from, kGramSize - a, (*gram)[a].begin() + a);
  }
}

GLINT_VECTOR_CLONES
void EvaluateAllRows(const KernelOptions& options, const TexelObservations& observations,
                     const TexelValues& texel, KernelRows* rows) {
  EvaluateLobes(observations, texel, rows);
  for (int c = 0; c < 3; ++c) EvaluateResiduals(options, observations, texel, c, rows);
}

GLINT_VECTOR_CLONES
void EvaluateProducts(const KernelOptions& options, const TexelObservations& observations,
                      const TexelValues& texel, KernelRows* rows, Products* products) {
  Lanes shared[kSharedProducts];
  for (auto& sum : shared) sum = Lanes{};
  EvaluateLobes(observations, texel, rows);
  for (int c = 0; c < 3; ++c) {
    EvaluateResiduals(options, observations, texel, c, rows);
    AccumulateChannel(*rows, c, observations.padded_views(), products->own[c], shared);
  }
  for (int i = 0; i < kSharedProducts; ++i) products->shared[i] = Sum(shared[i]);
}

GLINT_VECTOR_CLONES
void TakeAllLogarithms(int count, double* __restrict values, double* __restrict inverses) {
  for (int i = 0; i < count; ++i) {
    inverses[i] = 1.0 / values[i];
    values[i] = Log(values[i]);
  }
}

}  // namespace

KernelRows::KernelRows(int most_views)
    : stride_((most_views + kLanes - 1) / kLanes * kLanes),
      storage_(static_cast<size_t>(3 * kRows + kLobes) * stride_ + kLanes, 0.0) {
  constexpr std::uintptr_t kAlignment = kLanes * sizeof(double);
  const auto address = reinterpret_cast<std::uintptr_t>(storage_.data());
  const std::uintptr_t aligned = (address + kAlignment - 1) / kAlignment * kAlignment;
  rows_ = storage_.data() + (aligned - address) / sizeof(double);
}

void TakeLogarithms(int count, double* values, double* inverses) {
  TakeAllLogarithms(count, values, inverses);
}

void EvaluateRows(const KernelOptions& options, const TexelObservations& observations,
                  const TexelValues& texel, KernelRows* rows) {
  EvaluateAllRows(options, observations, texel, rows);
}

void EvaluateGram(const KernelOptions& options, const TexelObservations& observations,
                  const TexelValues& texel, KernelRows* rows, TexelGram* gram) {
  Products products;
  EvaluateProducts(options, observations, texel, rows, &products);
  FillGram(products, gram);
}

void LogDifferences(const double* residuals, int count, double robust_scale, double* differences) {
  // g² = 2δ²(√(1+t²) − 1)
  const double half_inverse = 0.5 / (robust_scale * robust_scale);
  for (int i = 0; i < count; ++i) {
    const double s = 1.0 + half_inverse * residuals[i] * residuals[i];
    differences[i] = robust_scale * std::sqrt(s * s - 1.0);
  }
}

}  // namespace glint
