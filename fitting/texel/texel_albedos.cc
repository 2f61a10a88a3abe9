#include "fitting/texel/texel_albedos.h"

#include <cmath>

#include "fitting/texel/texel_lobes.inl"
#include "fitting/texel/texel_vector.inl"

namespace glint {
namespace {

// Sums over the views of one channel for FitAlbedos: the model is C + k_d·A + k_s·B.
struct AlbedoSums {
  double aa, ab, bb, ay, by, yy;
};

// Weighted rows A, B and y = I − C of a channel, in the places of others of KernelRows.
enum AlbedoRow : int {
  kByLobe = KernelRows::kByDiffuse,
  kBySpecularAlbedo = KernelRows::kBySpecular,
  kUnexplained = KernelRows::kResidual
};

[[gnu::always_inline]] inline void EvaluateAlbedoRows(const TexelObservations& observations,
                                                      int channel, KernelRows* rows) {
  // The diffuse unknown is w·k_d: it has the slopes of w = 1.
  const DiffuseTerms<double> diffuse = EvaluateDiffuse(0.0, 0.0, false);
  const double* __restrict fresnel = observations.plane(TexelObservations::kFresnel);
  const double* __restrict irradiance =
      observations.plane(TexelObservations::kIrradiance + channel);
  const double* __restrict ambient = observations.plane(TexelObservations::kAmbient + channel);
  const double* __restrict ambient_specular =
      observations.plane(TexelObservations::kAmbientSpecular + channel);
  const double* __restrict target = observations.plane(TexelObservations::kInverseTarget + channel);
  const double* __restrict ceiling = observations.plane(TexelObservations::kCeiling + channel);
  const double* __restrict weight = observations.plane(TexelObservations::kWeight);
  const double* __restrict nl = rows->lobe(kNormalLight);
  const double* __restrict s = rows->lobe(kLobe);
  double* __restrict by_lobe = rows->row(channel, kByLobe);
  double* __restrict by_specular = rows->row(channel, kBySpecularAlbedo);
  double* __restrict unexplained = rows->row(channel, kUnexplained);
  const int views = observations.padded_views();
#pragma GCC ivdep
  for (int v = 0; v < views; ++v) {
    const double usable = ceiling[v] > 0.0 ? weight[v] : 0.0;
    const double relative = usable * target[v];  // weight/(I + 0.01)
    const ChannelTerms<double> terms = EvaluateChannel(diffuse, 0.0, fresnel[v], nl[v], s[v]);
    const ChannelSlopes<double> by = DifferentiateChannel(
        diffuse, terms, fresnel[v], nl[v], s[v], irradiance[v], ambient[v], ambient_specular[v]);
    by_lobe[v] = relative * by.by_diffuse;
    by_specular[v] = relative * by.by_specular;
    unexplained[v] = usable - relative * (irradiance[v] * terms.reflected + kLogOffset);
  }
}

[[gnu::always_inline]] inline AlbedoSums SumAlbedoProducts(const TexelObservations& observations,
                                                           const KernelRows& rows, int channel) {
  const auto load = [](const double* from) { return *reinterpret_cast<const Lanes*>(from); };
  Lanes aa{}, ab{}, bb{}, ay{}, by{}, yy{};
  for (int v = 0; v < observations.padded_views(); v += kLanes) {
    const Lanes a = load(rows.row(channel, kByLobe) + v);
    const Lanes b = load(rows.row(channel, kBySpecularAlbedo) + v);
    const Lanes y = load(rows.row(channel, kUnexplained) + v);
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
    EvaluateAlbedoRows(observations, c, rows);
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

}  // namespace

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
