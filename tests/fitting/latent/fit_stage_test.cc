#include "fitting/latent/fit_stage.h"

#include <gtest/gtest.h>

#include "fitting/estimator/estimator.h"
#include "fitting/weights/find_model.h"
#include "tests/fitting/bootstrap/synthetic_set.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

FitStageOptions WithMetals(const std::string& metals) {
  FitStageOptions options;
  options.method = "start";
  options.metals = metals;
  return options;
}

TEST(FitInputs, AreTheEstimatorForTheMetalsExpected) {
  const auto name = [](const FitStageOptions& options) {
    const std::vector<fs::path> inputs = FitInputs(options);
    return inputs.empty() ? "" : inputs.front().filename().string();
  };
  EXPECT_EQ(name(WithMetals("possible")), kEstimatorModel);
  EXPECT_EQ(name(WithMetals("rare")), kRareMetalsEstimatorModel);
  FitStageOptions heuristic = WithMetals("rare");
  heuristic.bootstrap = "heuristic";
  EXPECT_EQ(name(heuristic), "");
}

TEST(FitInputs, OfAnEstimatorThatIsGivenAreThatOne) {
  FitStageOptions options = WithMetals("rare");
  options.estimator = FindModel(kEstimatorModel);
  EXPECT_EQ(FitInputs(options), std::vector<fs::path>{options.estimator});
}

// Mean F0 that the shipped network takes the photograph's sample for.
double EstimatedSpecular(const char* model, const PhotographSet& set) {
  const SvbrdfMaps maps =
      Estimator::Load(FindModel(model))
          .Estimate(std::span(set.photographs).first(1), set.plane, set.convention, 1)
          .maps;
  double sum = 0;
  for (const float s : maps.plane(kSpecularG)) sum += s;
  return sum / static_cast<double>(maps.texels());
}

TEST(RareMetals, TakesABlackMirrorForGlass) {
  const PhotographSet glass = test::PhotographMaps(test::UniformMaps(128, 0.005f, 0.04f, 0.1f), 1);
  const double rare = EstimatedSpecular(kRareMetalsEstimatorModel, glass);
  EXPECT_LT(rare, 0.12);
  EXPECT_LT(rare, EstimatedSpecular(kEstimatorModel, glass));
}

}  // namespace
}  // namespace glint
