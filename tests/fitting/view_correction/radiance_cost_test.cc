#include "fitting/view_correction/radiance_cost.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/fitting/view_correction/disturbed_set.h"

namespace glint {
namespace {

TEST(RadianceCost, DerivativesMatchDifferences) {
  for (const bool inverse_square : {false, true}) {
    const test::DisturbedSet made = test::Disturb(3, 0.1, 0.5, true);
    ViewContext context;
    context.photograph = &made.set.photographs[1];
    context.plane = made.set.plane;
    context.convention = made.set.convention;
    if (inverse_square) {
      context.convention = {DiffuseWeight::kOneMinusSpecular, LightFalloff::kInverseSquare,
                            TexelSampling::kPixelCentres};
    }
    context.light_distance_mm = 2.3;
    context.irradiance = 3;
    context.weight = 50;
    double texel[kTexelSize] = {0.3, 0.2, 0.5, 0.1, 0.06, 0.04, 0.45, 0.2, -0.3};
    double light[3] = {0.02, -0.05, 0.01}, ambient[3] = {0.02, 0.03, 0.01}, exposure[1] = {0.1};
    double shifts[8] = {0.3, -0.2, 0.1, 0.4, -0.3, 0.2, 0.25, -0.1};
    double* parameters[] = {texel, light, ambient, exposure, shifts};
    const int sizes[] = {kTexelSize, 3, 3, 1, 8};
    const RadianceCost cost(context, 20, 31);
    std::vector<double> jacobian(3 * (kTexelSize + 3 + 3 + 1 + 8));
    double* blocks[5];
    double* next = jacobian.data();
    for (int b = 0; b < 5; ++b) {
      blocks[b] = next;
      next += 3 * sizes[b];
    }
    double residuals[3], above[3], below[3];
    ASSERT_TRUE(cost.Evaluate(parameters, residuals, blocks));
    for (int b = 0; b < 5; ++b) {
      for (int i = 0; i < sizes[b]; ++i) {
        const double kept = parameters[b][i], step = 1e-6;
        parameters[b][i] = kept + step;
        cost.Evaluate(parameters, above, nullptr);
        parameters[b][i] = kept - step;
        cost.Evaluate(parameters, below, nullptr);
        parameters[b][i] = kept;
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(blocks[b][c * sizes[b] + i], (above[c] - below[c]) / (2 * step), 1e-5)
              << "block " << b << " parameter " << i << " channel " << c;
        }
      }
    }
  }
}

}  // namespace
}  // namespace glint
