#include "fitting/latent/fit_stage.h"

#include <gtest/gtest.h>

#include "base/formats/rectified_set.h"
#include "fitting/estimator/estimator.h"
#include "fitting/weights/find_model.h"
#include "tests/fitting/initial_maps/synthetic_set.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

FitStageOptions WithMetals(const std::string& metals) {
  FitStageOptions options;
  options.method = "initial";
  options.metals = metals;
  return options;
}

TEST(FitInputs, AreTheEstimatorUnlessInitialMapsComeFromElsewhere) {
  const auto name = [](const FitStageOptions& options) {
    const std::vector<fs::path> inputs = FitInputs(options);
    return inputs.empty() ? "" : inputs.front().filename().string();
  };
  EXPECT_EQ(name(WithMetals("possible")), kEstimatorModel);
  EXPECT_EQ(name(WithMetals("rare")), kEstimatorModel);
  FitStageOptions rules = WithMetals("rare");
  rules.initial_maps = "rules";
  EXPECT_EQ(name(rules), "");
}

TEST(FitInputs, OfAnEstimatorThatIsGivenAreThatOne) {
  FitStageOptions options = WithMetals("rare");
  options.estimator = FindModel(kEstimatorModel);
  EXPECT_EQ(FitInputs(options), std::vector<fs::path>{options.estimator});
}

// Mean F0 that the shipped network takes the photographs' sample for.
double EstimatedSpecular(bool metals_rare, const PhotographSet& set) {
  const SvbrdfMaps maps =
      Estimator::Load(FindModel(kEstimatorModel)).Estimate(set, {metals_rare, true}, 1).maps;
  double sum = 0;
  for (const float s : maps.plane(kSpecularG)) sum += s;
  return sum / static_cast<double>(maps.texels());
}

TEST(RareMetals, TakesABlackMirrorForGlass) {
  const PhotographSet glass = test::PhotographMaps(test::UniformMaps(128, 0.005f, 0.04f, 0.1f), 1);
  const double rare = EstimatedSpecular(true, glass);
  EXPECT_LT(rare, 0.12);
  EXPECT_LT(rare, EstimatedSpecular(false, glass));
}

// A rectified set of three views, and the manifest's path.
fs::path WriteRectifiedViews(const fs::path& folder, bool light_power_known = true) {
  RectifiedSet set;
  set.light_power_known = light_power_known;
  set.plane = {8, 8, 2.0, 2.0, TexelSampling::kPixelCentres};
  CommonOptions common;
  common.threads = 1;
  Stage stage(folder, {"rectify", 1}, OptionSet(), common, {});
  for (const std::string name : {"view_000", "view_001", "view_002"}) {
    RectifiedView view;
    view.name = name;
    view.file = name + ".exr";
    view.photo = name + ".png";
    view.view.camera_in_sample_mm = view.view.light_in_sample_mm = {0, 0, 5};
    view.view.light_rgb = {1, 1, 1};
    set.views.push_back(view);
    RectifiedImage image;
    image.width = image.height = 8;
    image.rgb.assign(3 * 64, 0.5f);
    image.mask.assign(64, 1.0f);
    WriteRectifiedImage(stage.Output(view.file), image, set, view);
  }
  stage.Commit(ToJson(set), Json::object());
  return folder / "manifest.json";
}

TEST(ResolveFitOptions, PutsTheMethodsOwnNumbersWhereNoneAreGiven) {
  const test::TemporaryFolder folder;
  const fs::path manifest = WriteRectifiedViews(folder / "rectify");
  const auto resolved = [&](FitStageOptions options) {
    ResolveFitOptions(manifest, &options);
    return std::pair(options.iterations, options.fine_iterations);
  };
  FitStageOptions latent, classic, given, two;
  classic.method = "classic";
  two.exclude = {"view_002"};
  given.iterations = 17;
  EXPECT_EQ(resolved(latent), std::pair(100, 30));
  EXPECT_EQ(resolved(two), std::pair(300, 80));
  EXPECT_EQ(resolved(classic), std::pair(3000, 200));
  EXPECT_EQ(resolved(given), std::pair(17, 30));
}

// Fitting makes what is estimated of one photograph worse; who asks for steps gets them.
TEST(ResolveFitOptions, InitialMapsOfOnePhotographAreKept) {
  const test::TemporaryFolder folder;
  const fs::path manifest = WriteRectifiedViews(folder / "rectify");
  FitStageOptions single;
  single.exclude = {"view_001", "view_002"};
  FitStageOptions fitted = single;
  fitted.iterations = 8;
  ResolveFitOptions(manifest, &single);
  ResolveFitOptions(manifest, &fitted);
  EXPECT_EQ(single.method, "initial");
  EXPECT_EQ(single.estimator_size, 1024);
  EXPECT_EQ(fitted.method, "latent");
  EXPECT_EQ(fitted.iterations, 8);
}

// So that whoever reads a manifest knows what was done.
TEST(ResolveFitOptions, TheManifestHasNoNumberThatStandsForAnother) {
  const test::TemporaryFolder folder;
  FitStageOptions options;
  OptionSet set;
  AddFitOptions(&set, &options);
  ResolveFitOptions(WriteRectifiedViews(folder / "rectify"), &options);
  const Json echo = set.ManifestEcho();
  for (const char* name : {"iterations", "fine-iterations", "finest-size", "learning-rate"}) {
    EXPECT_GT(echo.at(name).get<double>(), 0) << name;
  }
  EXPECT_EQ(echo.at("tune-iterations"), 0);  // none are done
  EXPECT_EQ(echo.at("code-prior"), 0);
}

// Of the photographs' views, the manifest's path.
fs::path WriteRectified(const fs::path& folder, const PhotographSet& photographs) {
  RectifiedSet set;
  set.light_power_known = true;
  set.plane = photographs.plane;
  set.convention = photographs.convention;
  CommonOptions common;
  common.threads = 1;
  Stage stage(folder, {"rectify", 1}, OptionSet(), common, {});
  for (size_t i = 0; i < photographs.photographs.size(); ++i) {
    const Photograph& photograph = photographs.photographs[i];
    RectifiedView view;
    view.name = "view_00" + std::to_string(i);
    view.file = view.name + ".exr";
    view.photo = view.name + ".png";
    view.view = photograph.view;
    view.ldr = photograph.ldr;
    set.views.push_back(view);
    RectifiedImage image;
    image.width = set.plane.width;
    image.height = set.plane.height;
    image.rgb = photograph.rgb;
    image.mask = photograph.mask;
    WriteRectifiedImage(stage.Output(view.file), image, set, view);
  }
  stage.Commit(ToJson(set), Json::object());
  return folder / "manifest.json";
}

TEST(RunFitStage, LeavesOutAPhotographThatNoMapsExplainWithTheOthers) {
  const test::TemporaryFolder folder;
  PhotographSet photographs = test::PhotographMaps(test::UniformMaps(32, 0.5f, 0.04f, 0.4f), 7);
  FitStageOptions options;
  options.iterations = 60;
  options.fine_iterations = 20;
  const auto fit = [&](const std::string& name, const FitStageOptions& chosen) {
    const fs::path manifest = WriteRectified(folder / name, photographs);
    FitStageOptions resolved = chosen;
    ResolveFitOptions(manifest, &resolved);
    CommonOptions common;
    Stage stage(folder / (name + "_fit"), {"fit", kFitVersion}, OptionSet(), common, {manifest});
    return RunFitStage(manifest, resolved, 2, &stage);
  };
  const FitStageResult good = fit("good", options);
  EXPECT_TRUE(good.left_out.empty());
  EXPECT_EQ(good.data["views"].size(), 7u);
  for (float& value : photographs.photographs[3].rgb) value *= 0.2f;  // a shadow lies on it
  const FitStageResult odd = fit("odd", options);
  ASSERT_EQ(odd.left_out.size(), 1u);
  EXPECT_EQ(odd.left_out[0].name, "view_003");
  EXPECT_EQ(odd.data["views"].size(), 6u);
  EXPECT_EQ(odd.metrics["views"].size(), 6u);
  EXPECT_LT(odd.fit.final_loss, 1.2 * good.fit.final_loss);
  options.views = {"view_000", "view_001", "view_002", "view_003", "view_004"};  // one by one
  EXPECT_EQ(fit("chosen", options).data["views"].size(), 5u);
}

}  // namespace
}  // namespace glint
