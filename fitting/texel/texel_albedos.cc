#include "fitting/texel/texel_albedos.h"

#include <cmath>

#include "base/model/solver.h"

namespace glint {
namespace {

double Squares(const AlbedoSums& q, double a, double b) {
  return q.yy - 2.0 * (q.ay * a + q.by * b) + q.aa * a * a + 2.0 * q.ab * a * b + q.bb * b * b;
}

// Minimises the quadratic over the unit square: inside, or on the better of the edges.
double SolveInUnitSquare(const AlbedoSums& q, double* a, double* b) {
  const auto clamp = [](double x) { return x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x); };
  const double determinant = q.aa * q.bb - q.ab * q.ab;
  // The sums are of single precision.
  if (determinant > constants::kLeastAlbedoDeterminant * q.aa * q.bb) {
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

AlbedoFit FitAlbedos(const AlbedoSums sums[3], DiffuseWeight diffuse_weight,
                     const double prior_weights[6], const TexelValues& toward, TexelValues* texel) {
  AlbedoFit fit;
  for (int c = 0; c < 3; ++c) {
    double& diffuse = (*texel)[DiffuseParameter(c)];
    double& specular = (*texel)[SpecularParameter(c)];
    const bool one_minus = diffuse_weight == DiffuseWeight::kOneMinusSpecular;
    // The weight 1 − k_s goes into the diffuse unknown.
    double lobe = one_minus ? diffuse * (1.0 - specular) : diffuse;
    const double specular_start = toward[SpecularParameter(c)];
    const double lobe_start =
        toward[DiffuseParameter(c)] * (one_minus ? 1.0 - specular_start : 1.0);
    const double diffuse_prior = prior_weights[DiffuseParameter(c)];
    const double specular_prior = prior_weights[SpecularParameter(c)];
    AlbedoSums q = sums[c];
    q.aa += diffuse_prior;
    q.ay += diffuse_prior * lobe_start;
    q.bb += specular_prior;
    q.by += specular_prior * specular_start;
    q.yy +=
        diffuse_prior * lobe_start * lobe_start + specular_prior * specular_start * specular_start;
    fit.before += Squares(q, lobe, specular);
    fit.after += SolveInUnitSquare(q, &lobe, &specular);
    diffuse = lobe;
    if (one_minus) diffuse = specular < 1.0 ? std::fmin(lobe / (1.0 - specular), 1.0) : 0.0;
  }
  return fit;
}

}  // namespace glint
