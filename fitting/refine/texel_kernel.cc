#include "fitting/refine/texel_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

// One binary, the widest vector unit of the machine it runs on. Every operation is rounded the same
// way on all of them (no contraction), so results do not depend on the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define GLINT_VECTOR_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define GLINT_VECTOR_CLONES
#endif

namespace glint {
namespace {

enum Lobe { kNormalLight, kByXNormalLight, kByYNormalLight, kLobe, kByXLobe, kByYLobe, kByRLobe };

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));

// log(x) for finite normal x > 0 within 1 ulp, without branches or calls so that loops over it
// vectorise: the reduction and the polynomial of FreeBSD's e_log.c.
[[gnu::always_inline]] inline double Log(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  // Exponent such that the mantissa is in [√½, √2).
  constexpr std::uint64_t kSqrtHalf = 0x3fe6a09e00000000u;
  const std::uint64_t shifted = bits - kSqrtHalf + 0x3ff0000000000000u;
  const std::uint64_t biased = shifted >> 52;
  const std::uint64_t mantissa = (shifted & 0x000fffffffffffffu) + kSqrtHalf;
  // An integer below 2^52 becomes a double by writing it into the mantissa of 2^52.
  const std::uint64_t exponent_bits = biased | 0x4330000000000000u;
  double exponent, m;
  std::memcpy(&exponent, &exponent_bits, sizeof exponent);
  std::memcpy(&m, &mantissa, sizeof m);
  exponent -= 4503599627370496.0 + 1023.0;

  const double f = m - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double odd = w * (3.999999999940941908e-01 +
                          w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double even = z * (6.666666666666735130e-01 +
                           w * (2.857142874366239149e-01 +
                                w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half_square = 0.5 * f * f;
  return exponent * 6.93147180369123816490e-01 -
         ((half_square -
           (s * (half_square + (odd + even)) + exponent * 1.90821492927058770002e-10)) -
          f);
}

// n·l, the specular factor S = D·G/(4·NoL·NoV)·NoL and their derivatives, per view.
[[gnu::always_inline]] inline void EvaluateLobes(const TexelObservations& observations,
                                                 const TexelValues& texel, KernelRows* rows) {
  const double px = texel[kSlopeX], py = texel[kSlopeY], r = texel[kRough];
  const double length = 1.0 / std::sqrt(1.0 + px * px + py * py);
  const double nx = px * length, ny = py * length, nz = length;
  // ∂n/∂slope = length·(axis − n·n_axis)
  const double xx = length * (1.0 - nx * nx), xy = -length * nx * ny, xz = -length * nx * nz;
  const double yx = xy, yy = length * (1.0 - ny * ny), yz = -length * ny * nz;
  const double alpha = r * r;
  const double k = alpha * 0.5 > kDenominatorClamp ? alpha * 0.5 : kDenominatorClamp;
  const double k_by_alpha = alpha * 0.5 > kDenominatorClamp ? 0.5 : 0.0;
  const double alpha2 = alpha * alpha;
  const double one_minus_k = 1.0 - k;

  const double* __restrict lx = observations.plane(TexelObservations::kLightX);
  const double* __restrict ly = observations.plane(TexelObservations::kLightY);
  const double* __restrict lz = observations.plane(TexelObservations::kLightZ);
  const double* __restrict vx = observations.plane(TexelObservations::kCameraX);
  const double* __restrict vy = observations.plane(TexelObservations::kCameraY);
  const double* __restrict vz = observations.plane(TexelObservations::kCameraZ);
  const double* __restrict hx = observations.plane(TexelObservations::kHalfX);
  const double* __restrict hy = observations.plane(TexelObservations::kHalfY);
  const double* __restrict hz = observations.plane(TexelObservations::kHalfZ);
  double* __restrict out_nl = rows->lobe(kNormalLight);
  double* __restrict out_nl_x = rows->lobe(kByXNormalLight);
  double* __restrict out_nl_y = rows->lobe(kByYNormalLight);
  double* __restrict out_s = rows->lobe(kLobe);
  double* __restrict out_s_x = rows->lobe(kByXLobe);
  double* __restrict out_s_y = rows->lobe(kByYLobe);
  double* __restrict out_s_r = rows->lobe(kByRLobe);
  const int views = observations.padded_views();
#pragma GCC ivdep
  for (int v = 0; v < views; ++v) {
    const double nl_free = nx * lx[v] + ny * ly[v] + nz * lz[v];
    const double nv_free = nx * vx[v] + ny * vy[v] + nz * vz[v];
    const double nh_free = nx * hx[v] + ny * hy[v] + nz * hz[v];
    const double nl = nl_free > kDotClamp ? nl_free : kDotClamp;
    const double nv = nv_free > kDotClamp ? nv_free : kDotClamp;
    const double nh = nh_free > kDotClamp ? nh_free : kDotClamp;
    const double nl_on = nl_free > kDotClamp ? 1.0 : 0.0;
    const double nv_on = nv_free > kDotClamp ? 1.0 : 0.0;
    const double nh_on = nh_free > kDotClamp ? 1.0 : 0.0;

    const double t_free = 1.0 + nh * nh * (alpha2 - 1.0);
    const double t = t_free > kDenominatorClamp ? t_free : kDenominatorClamp;
    const double t_on = t_free > kDenominatorClamp ? 1.0 : 0.0;
    const double a = nl * one_minus_k + k;
    const double b = nv * one_minus_k + k;
    const double inverse = 1.0 / (t * a * b);  // one division for three
    const double inverse_t = inverse * a * b;
    const double inverse_a = inverse * t * b;
    const double inverse_b = inverse * t * a;
    const double ratio = alpha * inverse_t;
    const double p = (0.25 * kInversePi) * inverse_a * inverse_b;
    const double s_per_nl = ratio * ratio * p;
    const double s = s_per_nl * nl;
    const double by_t = -2.0 * s * inverse_t * t_on;
    const double by_alpha = 2.0 * ratio * inverse_t * p * nl + by_t * 2.0 * alpha * nh * nh -
                            k_by_alpha * s * ((1.0 - nl) * inverse_a + (1.0 - nv) * inverse_b);
    const double by_nl = s_per_nl * k * inverse_a * nl_on;
    const double by_nv = -s * one_minus_k * inverse_b * nv_on;
    const double by_nh = by_t * 2.0 * nh * (alpha2 - 1.0) * nh_on;

    const double nl_x = xx * lx[v] + xy * ly[v] + xz * lz[v];
    const double nl_y = yx * lx[v] + yy * ly[v] + yz * lz[v];
    const double nv_x = xx * vx[v] + xy * vy[v] + xz * vz[v];
    const double nv_y = yx * vx[v] + yy * vy[v] + yz * vz[v];
    const double nh_x = xx * hx[v] + xy * hy[v] + xz * hz[v];
    const double nh_y = yx * hx[v] + yy * hy[v] + yz * hz[v];
    out_nl[v] = nl;
    out_nl_x[v] = nl_x * nl_on;
    out_nl_y[v] = nl_y * nl_on;
    out_s[v] = s;
    out_s_x[v] = by_nl * nl_x + by_nv * nv_x + by_nh * nh_x;
    out_s_y[v] = by_nl * nl_y + by_nv * nv_y + by_nh * nh_y;
    out_s_r[v] = by_alpha * 2.0 * r;
  }
}

[[gnu::always_inline]] inline void EvaluateChannel(const KernelOptions& options,
                                                   const TexelObservations& observations,
                                                   const TexelValues& texel, int channel,
                                                   KernelRows* rows) {
  const double diffuse = texel[DiffuseParameter(channel)];
  const double specular = texel[SpecularParameter(channel)];
  const bool one_minus = options.diffuse_weight == DiffuseWeight::kOneMinusSpecular;
  const double by_diffuse_lobe = kInversePi * (one_minus ? 1.0 - specular : 1.0);
  const double lobe = diffuse * by_diffuse_lobe;
  const double lobe_by_specular = one_minus ? -kInversePi * diffuse : 0.0;
  const double inverse_scale = 1.0 / options.robust_scale;

  const double* __restrict fresnel = observations.plane(TexelObservations::kFresnel);
  const double* __restrict irradiance =
      observations.plane(TexelObservations::kIrradiance + channel);
  const double* __restrict ambient = observations.plane(TexelObservations::kAmbient + channel);
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
    const double e = irradiance[v];
    const double f = specular + (1.0 - specular) * fresnel[v];
    const double received = e * nl[v] + ambient[v];
    const double surround = ambient[v] * kInversePi;  // as the specular part reflects it
    const double offset_radiance =
        lobe * received + e * f * s[v] + specular * surround + kLogOffset;

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

    const double diffuse_normal = e * lobe;
    const double specular_normal = e * f;
    by_x[v] = chain * (diffuse_normal * nl_x[v] + specular_normal * s_x[v]);
    by_y[v] = chain * (diffuse_normal * nl_y[v] + specular_normal * s_y[v]);
    by_r[v] = chain * (specular_normal * s_r[v]);
    by_d[v] = chain * (by_diffuse_lobe * received);
    by_s[v] = chain * (e * s[v] * (1.0 - fresnel[v]) + surround + lobe_by_specular * received);
  }
}

[[gnu::always_inline]] inline double Sum(const Lanes& lanes) {
  using Half = double __attribute__((vector_size(4 * sizeof(double))));
  using Quarter = double __attribute__((vector_size(2 * sizeof(double))));
  const Half half = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3) +
                    __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
  const Quarter quarter =
      __builtin_shufflevector(half, half, 0, 1) + __builtin_shufflevector(half, half, 2, 3);
  return quarter[0] + quarter[1];
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
  for (int c = 0; c < 3; ++c) EvaluateChannel(options, observations, texel, c, rows);
}

GLINT_VECTOR_CLONES
void EvaluateProducts(const KernelOptions& options, const TexelObservations& observations,
                      const TexelValues& texel, KernelRows* rows, Products* products) {
  Lanes shared[kSharedProducts];
  for (auto& sum : shared) sum = Lanes{};
  EvaluateLobes(observations, texel, rows);
  for (int c = 0; c < 3; ++c) {
    EvaluateChannel(options, observations, texel, c, rows);
    AccumulateChannel(*rows, c, observations.padded_views(), products->own[c], shared);
  }
  for (int i = 0; i < kSharedProducts; ++i) products->shared[i] = Sum(shared[i]);
}

// Sums over the views of one channel for FitAlbedos: the model is C + k_d·A + k_s·B.
struct AlbedoSums {
  double aa, ab, bb, ay, by, yy;
};

[[gnu::always_inline]] inline AlbedoSums SumAlbedoProducts(const TexelObservations& observations,
                                                           const KernelRows& rows, int channel) {
  const auto load = [](const double* from) { return *reinterpret_cast<const Lanes*>(from); };
  const double* inverse = rows.row(channel, KernelRows::kByDiffuse);  // weight/(I + 0.01)
  Lanes aa{}, ab{}, bb{}, ay{}, by{}, yy{};
  for (int v = 0; v < observations.padded_views(); v += kLanes) {
    const Lanes e = load(observations.plane(TexelObservations::kIrradiance + channel) + v);
    const Lanes ambient = load(observations.plane(TexelObservations::kAmbient + channel) + v);
    const Lanes fresnel = load(observations.plane(TexelObservations::kFresnel) + v);
    const Lanes nl = load(rows.lobe(kNormalLight) + v);
    const Lanes s = load(rows.lobe(kLobe) + v);
    const Lanes w = load(inverse + v);
    const Lanes usable = load(rows.row(channel, KernelRows::kResidual) + v);
    const Lanes a = w * (e * nl + ambient) * kInversePi;
    const Lanes b = w * (e * s * (1.0 - fresnel) + ambient * kInversePi);
    const Lanes y = usable - w * (e * s * fresnel + kLogOffset);
    aa += a * a;
    ab += a * b;
    bb += b * b;
    ay += a * y;
    by += b * y;
    yy += y * y;
  }
  return {Sum(aa), Sum(ab), Sum(bb), Sum(ay), Sum(by), Sum(yy)};
}

GLINT_VECTOR_CLONES
void EvaluateAlbedoSums(const TexelObservations& observations, const TexelValues& texel,
                        KernelRows* rows, AlbedoSums sums[3]) {
  EvaluateLobes(observations, texel, rows);
  for (int c = 0; c < 3; ++c) {
    const double* __restrict target = observations.plane(TexelObservations::kInverseTarget + c);
    const double* __restrict ceiling = observations.plane(TexelObservations::kCeiling + c);
    const double* __restrict weight = observations.plane(TexelObservations::kWeight);
    double* __restrict usable = rows->row(c, KernelRows::kResidual);
    double* __restrict inverse = rows->row(c, KernelRows::kByDiffuse);
    for (int v = 0; v < observations.padded_views(); ++v) {
      usable[v] = ceiling[v] > 0.0 ? weight[v] : 0.0;
      inverse[v] = usable[v] * target[v];
    }
    sums[c] = SumAlbedoProducts(observations, *rows, c);
  }
}

double Squares(const AlbedoSums& q, double a, double b) {
  return q.yy - 2.0 * (q.ay * a + q.by * b) + q.aa * a * a + 2.0 * q.ab * a * b + q.bb * b * b;
}

// Minimises the quadratic over the unit square: inside, or on the better of the edges.
double SolveInUnitSquare(const AlbedoSums& q, double* a, double* b) {
  const auto clamp = [](double x) { return x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x); };
  const double determinant = q.aa * q.bb - q.ab * q.ab;
  if (determinant > 1e-12 * q.aa * q.bb) {
    const double x = (q.ay * q.bb - q.by * q.ab) / determinant;
    const double y = (q.by * q.aa - q.ay * q.ab) / determinant;
    if (x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0) {
      *a = x;
      *b = y;
      return Squares(q, x, y);
    }
  }
  double best = Squares(q, *a, *b);
  const auto take = [&](double x, double y) {
    const double found = Squares(q, x, y);
    if (found >= best) return;
    best = found;
    *a = x;
    *b = y;
  };
  for (const double edge : {0.0, 1.0}) {
    if (q.bb > 0.0) take(edge, clamp((q.by - q.ab * edge) / q.bb));
    if (q.aa > 0.0) take(clamp((q.ay - q.ab * edge) / q.aa), edge);
  }
  return best;
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

AlbedoFit FitAlbedos(const KernelOptions& options, const TexelObservations& observations,
                     const double holds[6], const TexelValues& toward, TexelValues* texel,
                     KernelRows* rows) {
  AlbedoSums sums[3];
  EvaluateAlbedoSums(observations, *texel, rows, sums);
  AlbedoFit fit;
  for (int c = 0; c < 3; ++c) {
    double& diffuse = (*texel)[DiffuseParameter(c)];
    double& specular = (*texel)[SpecularParameter(c)];
    const bool one_minus = options.diffuse_weight == DiffuseWeight::kOneMinusSpecular;
    // The weight 1 − k_s goes into the diffuse unknown.
    double lobe = one_minus ? diffuse * (1.0 - specular) : diffuse;
    const double specular_start = toward[SpecularParameter(c)];
    const double lobe_start =
        toward[DiffuseParameter(c)] * (one_minus ? 1.0 - specular_start : 1.0);
    const double diffuse_hold = holds[DiffuseParameter(c)];
    const double specular_hold = holds[SpecularParameter(c)];
    AlbedoSums& q = sums[c];
    q.aa += diffuse_hold;
    q.ay += diffuse_hold * lobe_start;
    q.bb += specular_hold;
    q.by += specular_hold * specular_start;
    q.yy +=
        diffuse_hold * lobe_start * lobe_start + specular_hold * specular_start * specular_start;
    fit.before += Squares(q, lobe, specular);
    fit.after += SolveInUnitSquare(q, &lobe, &specular);
    diffuse = lobe;
    if (one_minus) diffuse = specular < 1.0 ? std::fmin(lobe / (1.0 - specular), 1.0) : 0.0;
  }
  return fit;
}

}  // namespace glint
