#include "base/reflectance/brdf.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/reflectance/texel_at.h"
#include "tests/base/reflectance/texel_jacobian.h"

namespace glint {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kPoints = 1000;

struct Point {
  TexelSvbrdf<double> texel;
  TexelGeometry<double> geometry;
};

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : engine_(seed) {}

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  // A unit vector at most `degrees` from +z.
  std::array<double, 3> Direction(double degrees) {
    const double cosine = Uniform(std::cos(degrees * kPi / 180), 1.0);
    const double sine = std::sqrt(1 - cosine * cosine);
    const double azimuth = Uniform(0, 2 * kPi);
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
  }

  // A point in general position: normal tilted up to 60°, light and camera up to 70°, so that
  // clamped (self-shadowed) texels occur too.
  Point Next() {
    Point point;
    const auto normal = Direction(60);
    std::copy(normal.begin(), normal.end(), point.texel.normal);
    for (int c = 0; c < 3; ++c) {
      point.texel.diffuse[c] = Uniform(0.01, 1);
      point.texel.specular[c] = Uniform(0.01, 1);
    }
    point.texel.roughness = Uniform(0.05, 1);
    point.geometry = Geometry(Direction(70), Direction(70));
    return point;
  }

  TexelGeometry<double> Geometry(const std::array<double, 3>& light,
                                 const std::array<double, 3>& camera) {
    const double irradiance[3] = {Uniform(0.1, 4), Uniform(0.1, 4), Uniform(0.1, 4)};
    const double ambient[3] = {Uniform(0, 0.5), Uniform(0, 0.5), Uniform(0, 0.5)};
    return MakeTexelGeometry(light.data(), camera.data(), irradiance, ambient);
  }

 private:
  std::mt19937 engine_;
};

// tan² between the normal and h: by h's slopes along the tangent, 1/ratio as much, and across it.
double StretchedTangent2(const double n[3], const double h[3], const Anisotropy& anisotropy) {
  const double noh = n[0] * h[0] + n[1] * h[1] + n[2] * h[2];
  if (noh < 1e-8) return 1e16 - 1;
  const double azimuth = anisotropy.direction_deg * kPi / 180;
  const double g[3] = {std::cos(azimuth), std::sin(azimuth), 0};
  const double n_dot_g = n[0] * g[0] + n[1] * g[1];
  double t[3], length = 0;
  for (int i = 0; i < 3; ++i) t[i] = g[i] - n_dot_g * n[i];
  for (const double x : t) length += x * x;
  for (double& x : t) x /= std::sqrt(length);
  const double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2],
                       n[0] * t[1] - n[1] * t[0]};
  const double along = (h[0] * t[0] + h[1] * t[1] + h[2] * t[2]) / noh;
  const double across = (h[0] * b[0] + h[1] * b[1] + h[2] * b[2]) / noh;
  return along * along / anisotropy.ratio + across * across * anisotropy.ratio;
}

// The model written as method.md prints it, one line a formula, with nothing rearranged.
std::array<double, 3> TextbookRadiance(const Point& point, const ReflectanceConvention& model) {
  const auto clamped_dot = [](const double a[3], const double b[3]) {
    return std::max(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], 1e-8);
  };
  const TexelSvbrdf<double>& s = point.texel;
  const TexelGeometry<double>& g = point.geometry;
  double h[3], length = 0;
  for (int i = 0; i < 3; ++i) length += (g.light[i] + g.camera[i]) * (g.light[i] + g.camera[i]);
  for (int i = 0; i < 3; ++i) h[i] = (g.light[i] + g.camera[i]) / std::sqrt(length);
  const double noh = clamped_dot(s.normal, h), nol = clamped_dot(s.normal, g.light);
  const double nov = clamped_dot(s.normal, g.camera), voh = clamped_dot(g.camera, h);
  const auto lobe = [&](double roughness) {  // D·G
    const double alpha = roughness * roughness, k = alpha / 2;
    const double tail = model.lobes.tail_exponent;
    const double tangent2 = StretchedTangent2(s.normal, h, model.lobes.anisotropy);
    const double d =
        std::pow(tail - 1, tail) * std::pow(alpha, 2 * tail - 2) /
        (kPi * std::pow(noh, 4) * std::pow((tail - 1) * alpha * alpha + tangent2, tail));
    const auto g1 = [k](double x) { return x / (x * (1 - k) + k); };
    return d * g1(nol) * g1(nov);
  };
  const double share = model.lobes.narrow_share, ratio = model.lobes.narrow_ratio;
  const double wide = std::min(1.0, s.roughness * std::pow(ratio, -share));
  const double narrow = std::min(1.0, s.roughness * std::pow(ratio, 1 - share));
  const bool coated = model.lobes.coat_f0 > 0;
  std::array<double, 3> radiance;
  for (int c = 0; c < 3; ++c) {
    const double f0 = s.specular[c], narrow_f0 = coated ? model.lobes.coat_f0 : f0;
    const auto f = [&](double at_normal) {
      return at_normal + (1 - at_normal) * std::pow(2.0, voh * (-5.55473 * voh - 6.98316));
    };
    const double w = model.diffuse_weight == DiffuseWeight::kOne ? 1 : 1 - f0;
    const double lobes = (1 - share) * lobe(wide) * f(f0) + share * lobe(narrow) * f(narrow_f0);
    const double brdf = w * s.diffuse[c] / kPi + lobes / (4 * nol * nov);
    const double mirrored = (1 - share) * f0 + share * narrow_f0;
    radiance[c] = g.irradiance[c] * brdf * nol + g.ambient[c] * (w * s.diffuse[c] + mirrored) / kPi;
  }
  return radiance;
}

// Each diffuse weight, with one specular lobe, with two and with a coat's; and with shorter tails.
const std::array<ReflectanceConvention, 11> kModels = {
    {{.diffuse_weight = DiffuseWeight::kOne},
     {.diffuse_weight = DiffuseWeight::kOneMinusSpecular},
     {.diffuse_weight = DiffuseWeight::kOne, .lobes = {0.5, 0.4}},
     {.diffuse_weight = DiffuseWeight::kOneMinusSpecular, .lobes = {0.85, 0.25}},
     {.diffuse_weight = DiffuseWeight::kOne, .lobes = {0.3, 0.4, 0.04}},
     {.diffuse_weight = DiffuseWeight::kOneMinusSpecular, .lobes = {0.85, 0.25, 0.03}},
     {.diffuse_weight = DiffuseWeight::kOne, .lobes = {.tail_exponent = 4}},
     {.diffuse_weight = DiffuseWeight::kOneMinusSpecular, .lobes = {.tail_exponent = 3}},
     {.diffuse_weight = DiffuseWeight::kOne, .lobes = {0.3, 0.4, 0.04, 8}},
     {.diffuse_weight = DiffuseWeight::kOne, .lobes = {.anisotropy = {2.5, 30}}},
     {.diffuse_weight = DiffuseWeight::kOneMinusSpecular, .lobes = {0.5, 0.4, 0, 4, {1.5, 120}}}}};

TEST(BrdfTest, RadianceIsTheTextbookFormula) {
  RandomPoints random(1);
  for (const ReflectanceConvention& model : kModels) {
    for (int i = 0; i < kPoints; ++i) {
      const Point point = random.Next();
      const auto expected = TextbookRadiance(point, model);
      double radiance[3];
      ShadeRadiance(point.texel, point.geometry, model, radiance);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[c], expected[c], 1e-9 * expected[c]);
    }
  }
}

TEST(BrdfTest, ClampedDotProductsFollowTheTextbookToo) {
  RandomPoints random(2);
  int behind_camera = 0, behind_half = 0;
  for (int i = 0; i < kPoints; ++i) {
    Point point = random.Next();
    point.geometry = random.Geometry(random.Direction(88), random.Direction(88));
    for (double& x : point.texel.normal) x = -x;  // mostly turned away from one or both
    if (i % 2) std::swap(point.texel.normal[0], point.texel.normal[2]);
    behind_camera += Dot(point.texel.normal, point.geometry.camera) < 0;
    behind_half += Dot(point.texel.normal, point.geometry.half) < 0;
    const auto expected = TextbookRadiance(point, {DiffuseWeight::kOne});
    double radiance[3];
    ShadeRadiance(point.texel, point.geometry, {DiffuseWeight::kOne}, radiance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[c], expected[c], 1e-9 * expected[c]);
  }
  EXPECT_GT(behind_camera, kPoints / 4);
  EXPECT_GT(behind_half, kPoints / 4);
}

TEST(BrdfTest, Reciprocity) {
  RandomPoints random(3);
  for (int i = 0; i < kPoints; ++i) {
    const Point point = random.Next();
    const TexelGeometry<double>& g = point.geometry;
    const auto swapped = MakeTexelGeometry(g.camera, g.light, g.irradiance, g.ambient);
    double forward[3], backward[3];
    EvaluateBrdf(point.texel, g, {DiffuseWeight::kOne}, forward);
    EvaluateBrdf(point.texel, swapped, {DiffuseWeight::kOne}, backward);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(forward[c], backward[c], 1e-6 * forward[c]);
  }
}

TEST(BrdfTest, DistributionOfNormalsProjectsToOne) {
  for (const double roughness : {0.05, 0.1, 0.2, 0.4, 0.7, 1.0}) {
    double integral = 0;
    constexpr int kSteps = 20000;
    double previous = 0;
    for (int i = 1; i <= kSteps; ++i) {
      // Steps in x = sin²θ, finest at the peak; cosθ dω = π dx.
      const double x = std::pow(static_cast<double>(i) / kSteps, 6);
      const double middle = 0.5 * (x + previous);
      const double half[3] = {std::sqrt(middle), 0, std::sqrt(1 - middle)};
      const TexelSvbrdf<double> texel{{0, 0, 1}, {}, {}, roughness};
      TexelGeometry<double> geometry{{0, 0, 1}, {0, 0, 1}, {}, 0, {}, {}, {}};
      std::copy_n(half, 3, geometry.half);
      const double ratio = EvaluateSpecular(texel, geometry).ratio;
      integral += ratio * ratio / kPi * kPi * (x - previous);
      previous = x;
    }
    EXPECT_NEAR(integral, 1.0, 1e-3) << "roughness " << roughness;
  }
}

using Jet = ceres::Jet<double, kSvbrdfPlanes>;

TexelSvbrdf<Jet> AsVariables(const TexelSvbrdf<double>& texel) {
  TexelSvbrdf<Jet> jets;
  for (int i = 0; i < 3; ++i) {
    jets.normal[i] = Jet(texel.normal[i], kNormalX + i);
    jets.diffuse[i] = Jet(texel.diffuse[i], kDiffuseR + i);
    jets.specular[i] = Jet(texel.specular[i], kSpecularR + i);
  }
  jets.roughness = Jet(texel.roughness, kRoughness);
  return jets;
}

void ExpectJacobianMatchesAutodiff(const Point& point, const ReflectanceConvention& model,
                                   double tolerance) {
  double radiance[3], jacobian[3 * kSvbrdfPlanes];
  ShadeTexel(point.texel, point.geometry, model, radiance, jacobian);
  Jet expected[3];
  ShadeRadiance(AsVariables(point.texel), GeometryAs<Jet>(point.geometry), model, expected);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(radiance[c], expected[c].a, 1e-12 * std::abs(expected[c].a));
    const double largest = expected[c].v.cwiseAbs().maxCoeff();
    for (int p = 0; p < kSvbrdfPlanes; ++p) {
      const double derivative = expected[c].v[p];
      // Relative, but not of an entry that is itself the rounding of larger ones.
      EXPECT_NEAR(jacobian[c * kSvbrdfPlanes + p], derivative,
                  tolerance * std::max(std::abs(derivative), 1e-6 * largest))
          << "channel " << c << " plane " << p << " roughness " << point.texel.roughness;
    }
  }
}

TEST(BrdfDerivativesTest, JacobianMatchesAutodiff) {
  RandomPoints random(4);
  for (const ReflectanceConvention& model : kModels) {
    for (int i = 0; i < kPoints; ++i) ExpectJacobianMatchesAutodiff(random.Next(), model, 1e-6);
  }
}

TEST(BrdfDerivativesTest, JacobianMatchesAutodiffBesideClamps) {
  RandomPoints random(5);
  int dark = 0, hidden = 0, narrow = 0;
  for (int i = 0; i < kPoints; ++i) {
    Point point = random.Next();
    // Turn the normal until its dot product with light or camera is just beside the clamp.
    const double* target = i % 2 ? point.geometry.light : point.geometry.camera;
    const double wanted =
        kDotClamp + random.Uniform(-1, 1) * std::pow(10.0, random.Uniform(-12, -2));
    const double excess = Dot(point.texel.normal, target);
    double length = 0;
    for (int a = 0; a < 3; ++a) {
      point.texel.normal[a] -= excess * target[a];
      length += point.texel.normal[a] * point.texel.normal[a];
    }
    for (int a = 0; a < 3; ++a) {
      point.texel.normal[a] =
          point.texel.normal[a] / std::sqrt(length) * std::sqrt(1 - wanted * wanted) +
          wanted * target[a];
    }
    if (i % 5 == 0) {  // and a mirror, seen in its own reflection: D's denominator is clamped
      std::copy_n(point.geometry.half, 3, point.texel.normal);
      point.texel.roughness = random.Uniform(1e-5, 0.02);
      narrow += point.texel.roughness < 0.01;
    } else {
      (i % 2 ? dark : hidden) += wanted < kDotClamp;
    }
    ExpectJacobianMatchesAutodiff(point, kModels[static_cast<size_t>(i / 2) % kModels.size()],
                                  1e-4);
  }
  EXPECT_GT(std::min({dark, hidden, narrow}), kPoints / 20);
}

TEST(BrdfDerivativesTest, TangentDerivativesMatchDifferencesOfTheTextbookFormula) {
  RandomPoints random(6);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < kPoints; ++i) {
    const Point point = random.Next();
    if (std::min({Dot(point.texel.normal, point.geometry.light),
                  Dot(point.texel.normal, point.geometry.camera)}) < 0.01) {
      continue;  // differences across a clamp mean nothing
    }
    const SpecularLobes& lobes = kModels[static_cast<size_t>(i) % kModels.size()].lobes;
    const double widest = point.texel.roughness * std::pow(lobes.narrow_ratio, -lobes.narrow_share);
    if (lobes.two() && std::abs(widest - 1) < 1e-3) continue;
    const ReflectanceConvention& model = kModels[static_cast<size_t>(i) % kModels.size()];
    double radiance[3], jacobian[3 * kSvbrdfPlanes];
    ShadeTexel(point.texel, point.geometry, model, radiance, jacobian);
    const auto along = random.Direction(90);
    const auto moved = [&](double step) {
      Point copy = point;
      double length = 0;
      for (int a = 0; a < 3; ++a) {
        copy.texel.normal[a] += step * along[a];
        length += copy.texel.normal[a] * copy.texel.normal[a];
      }
      for (double& x : copy.texel.normal) x /= std::sqrt(length);
      copy.texel.roughness += step;
      return TextbookRadiance(copy, model);
    };
    const double radial = along[0] * point.texel.normal[0] + along[1] * point.texel.normal[1] +
                          along[2] * point.texel.normal[2];
    const auto m2 = moved(-2 * kStep), m1 = moved(-kStep), p1 = moved(kStep), p2 = moved(2 * kStep);
    for (int c = 0; c < 3; ++c) {
      const double* row = jacobian + c * kSvbrdfPlanes;
      double expected = row[kRoughness], scale = std::abs(expected);
      for (int a = 0; a < 3; ++a) {
        const double term = row[kNormalX + a] * (along[a] - radial * point.texel.normal[a]);
        expected += term;
        scale += std::abs(term);
      }
      const double difference = (8 * (p1[c] - m1[c]) - (p2[c] - m2[c])) / (12 * kStep);
      EXPECT_NEAR(difference, expected, 1e-6 * scale + 1e-9) << point.texel.roughness;
    }
  }
}

TEST(BrdfTest, SinglePrecisionKeepsNarrowHighlights) {
  RandomPoints random(7);
  double worst = 0;
  for (int i = 0; i < kPoints; ++i) {
    Point point = random.Next();
    point.texel.roughness = random.Uniform(0.05, 0.2);
    const auto light = random.Direction(30), camera = random.Direction(30);
    point.geometry = random.Geometry(light, camera);
    double length = 0;  // a normal near the half vector: in the highlight
    for (int a = 0; a < 3; ++a) {
      point.texel.normal[a] = point.geometry.half[a] + random.Uniform(-0.01, 0.01);
      length += point.texel.normal[a] * point.texel.normal[a];
    }
    for (double& x : point.texel.normal) x /= std::sqrt(length);
    TexelSvbrdf<float> texel;
    for (int a = 0; a < 3; ++a) {
      texel.normal[a] = static_cast<float>(point.texel.normal[a]);
      texel.diffuse[a] = static_cast<float>(point.texel.diffuse[a]);
      texel.specular[a] = static_cast<float>(point.texel.specular[a]);
    }
    texel.roughness = static_cast<float>(point.texel.roughness);
    float l[3], v[3], e[3], ambient[3], radiance[3];
    for (int a = 0; a < 3; ++a) {
      l[a] = static_cast<float>(light[a]);
      v[a] = static_cast<float>(camera[a]);
      e[a] = static_cast<float>(point.geometry.irradiance[a]);
      ambient[a] = static_cast<float>(point.geometry.ambient[a]);
    }
    ShadeRadiance(texel, MakeTexelGeometry(l, v, e, ambient), {DiffuseWeight::kOne}, radiance);
    const auto expected = TextbookRadiance(point, {DiffuseWeight::kOne});
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(radiance[c] / expected[c] - 1));
    }
  }
  EXPECT_LT(worst, 2e-4);  // 1 − NoH² in single precision loses up to 1e-1 here
}

}  // namespace
}  // namespace glint
