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

[[gnu::always_inline]] inline AlbedoSums SumAlbedoProducts(const TexelObservations& observations,
                                                           const KernelRows& rows, int channel) {
  const auto load = [](const double* from) { return *reinterpret_cast<const Lanes*>(from); };
  const double* inverse = rows.row(channel, KernelRows::kByDiffuse);  // weight/(I + 0.01)
  Lanes aa{}, ab{}, bb{}, ay{}, by{}, yy{};
  for (int v = 0; v < observations.padded_views(); v += kLanes) {
    const Lanes e = load(observations.plane(TexelObservations::kIrradiance + channel) + v);
    const Lanes ambient = load(observations.plane(TexelObservations::kAmbient + channel) + v);
    const Lanes ambient_specular =
        load(observations.plane(TexelObservations::kAmbientSpecular + channel) + v);
    const Lanes fresnel = load(observations.plane(TexelObservations::kFresnel) + v);
    const Lanes nl = load(rows.lobe(kNormalLight) + v);
    const Lanes s = load(rows.lobe(kLobe) + v);
    const Lanes w = load(inverse + v);
    const Lanes usable = load(rows.row(channel, KernelRows::kResidual) + v);
    const Lanes a = w * (e * nl + ambient) * kInversePi;
    const Lanes b = w * (e * s * (1.0 - fresnel) + ambient_specular * kInversePi);
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
