#include "fitting/latent/fit_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/errors/errors.h"
#include "base/formats/deviation_rows.h"
#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_file.h"
#include "base/formats/svbrdf_rows.h"
#include "base/programs/progress.h"
#include "base/resampling/resampling.h"
#include "fitting/estimator/estimator.h"
#include "fitting/initial_maps/rules.h"
#include "fitting/latent/levels.h"
#include "fitting/latent/light_power.h"
#include "fitting/latent/spread_views.h"
#include "fitting/photographs/odd_views.h"
#include "fitting/rectified_photographs/rectified_photographs.h"
#include "fitting/weights/find_model.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Of few photographs the estimator sees all detail up to this size, of more refinement finds it
// itself: docs/experiments/one-photograph.md.
constexpr size_t kFewPhotographs = 2;
constexpr int kMostEstimatorSize = 1024;

// Photographs that a fit under moving lights uses: docs/experiments/moving-light.md.
constexpr size_t kMostLights = 16;

constexpr int kFullSize = 1 << 20;  // more than any maps have along a side

bool IsLatent(const FitStageOptions& options) { return options.method == "latent"; }

FitOptions FitOptionsOf(const FitStageOptions& options, int threads) {
  FitOptions fit = IsLatent(options) ? FitOptions::Latent() : FitOptions::Classic();
  fit.coarse_iterations = options.iterations;
  fit.fine_iterations = options.fine_iterations;
  if (IsLatent(options)) fit.finest_size = std::max(options.finest_size, fit.coarse_size);
  fit.learning_rate = options.learning_rate;
  fit.tune_iterations = options.tune_iterations;
  fit.tune_rate = options.tune_rate;
  fit.code_prior = options.code_prior;
  fit.threads = threads;
  return fit;
}

// Errors of the auto-encoder name file, part, found and remedy; here they become the user's.
template <class Action>
auto AsUserError(const Action& action) {
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw UserError(error.what());
  }
}

bool Estimates(const FitStageOptions& options) {
  return options.start.empty() && options.initial_maps == "estimator";
}

using Size = std::pair<int, int>;  // width, height

// Of what is fitted, or of initial maps that are kept; finer detail is left to refinement.
Size FittedSize(const SamplePlane& plane, const FitStageOptions& options, const FitOptions& fit) {
  if (options.method == "initial") {
    return SizeAtMost(plane.width, plane.height,
                      Estimates(options) ? options.estimator_size : kFullSize);
  }
  return LevelSizes(plane.width, plane.height, fit.coarse_size, fit.finest_size).back();
}

// Of the photographs that initial maps are estimated from. Of a first level's detail nothing more
// is kept than it can hold.
Size ShownSize(const SamplePlane& plane, const FitStageOptions& options, const FitOptions& fit) {
  if (Estimates(options)) return SizeAtMost(plane.width, plane.height, options.estimator_size);
  if (options.method == "initial" || !options.start.empty()) return {plane.width, plane.height};
  return LevelSizes(plane.width, plane.height, fit.coarse_size, fit.finest_size).front();
}

// At a size that both of these can be averaged from.
PhotographSet Load(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                   const Size& fitted, const Size& shown, int threads) {
  RectifiedPhotographs source(set, views);
  PhotographSet photographs = source.Downsampled(std::max(fitted.first, shown.first),
                                                 std::max(fitted.second, shown.second), threads);
  if (const std::string wrong = photographs.Check(); !wrong.empty()) {
    throw UserError(set.manifest_file, "data.views", wrong,
                    "check the photographs and run rectify again");
  }
  return photographs;
}

// svbrdf.exr at the set's size, by rows.
void WriteAtSize(const fs::path& file, const SvbrdfMaps& maps, const RectifiedSet& set) {
  const SamplePlane& plane = set.plane;
  if (maps.width == plane.width && maps.height == plane.height) {
    WriteSvbrdf(file, maps, set.convention);
    return;
  }
  constexpr int kRowsAtOnce = 256;
  const EncodedMaps encoded = EncodeMaps(maps);
  SvbrdfWriter writer(file, plane.width, plane.height, set.convention);
  for (int first = 0; first < plane.height; first += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, plane.height - first);
    writer.Write(DecodeMaps(ResizedRows(encoded, plane.width, plane.height, first, rows)));
  }
  writer.Close();
}

fs::path EstimatorWeights(const FitStageOptions& options) {
  return AsUserError([&] { return FindModel(kEstimatorModel, options.estimator); });
}

// Maps to begin with, and what their light's power is to be multiplied with.
struct Initial {
  SvbrdfMaps maps;
  SvbrdfDeviations deviations;  // empty: not known
  PowerEstimate power;
};

SvbrdfEstimate EstimatedAs(const ReflectanceConvention& convention, SvbrdfEstimate estimate) {
  if (convention.diffuse_weight == DiffuseWeight::kOne) return estimate;
  for (int c = 0; c < 3; ++c) {  // the same look with diffuse weight 1 − k_s
    for (size_t i = 0; i < estimate.maps.texels(); ++i) {
      const float weight = std::max(0.05f, 1 - estimate.maps.plane(kSpecularR + c)[i]);
      float& diffuse = estimate.maps.plane(kDiffuseR + c)[i];
      diffuse = std::min(1.0f, diffuse / weight);
      estimate.deviations.plane(kSigmaDiffuseR + c)[i] /= weight;
    }
  }
  return estimate;
}

Initial Estimated(const FitStageOptions& options, const PhotographSet& photographs,
                  const EstimatorConditions& conditions, int threads) {
  const fs::path weights = EstimatorWeights(options);
  const Estimator estimator = AsUserError([&] { return Estimator::Load(weights); });
  PowerEstimate power;
  if (!photographs.light_power_known) {
    power = EstimatePower(estimator, photographs, conditions, threads);
  }
  SvbrdfEstimate estimate =
      EstimatedAs(photographs.convention,
                  estimator.Estimate(WithPower(photographs, power.factor), conditions, threads));
  return {std::move(estimate.maps), std::move(estimate.deviations), power};
}

// Where fitting begins: of the photographs' size, unless they come from a file.
Initial InitialMaps(const FitStageOptions& options, const PhotographSet& photographs,
                    const EstimatorConditions& conditions, int threads) {
  if (!options.start.empty()) return {ReadSvbrdf(options.start), {}, {}};
  if (Estimates(options)) return Estimated(options, photographs, conditions, threads);
  return {EstimateMaps(photographs, threads), {}, {}};
}

// The detail of initial maps that the fit's size does not hold, added to what was fitted to them:
// the learned space corrects what is coarse, and has not seen the rest.
SvbrdfMaps WithDetail(const SvbrdfMaps& fitted, const SvbrdfMaps& initial) {
  if (initial.width <= fitted.width && initial.height <= fitted.height) return fitted;
  const EncodedMaps fine = EncodeMaps(initial);
  const EncodedMaps coarse =
      Resized(Resized(fine, fitted.width, fitted.height), fine.width, fine.height);
  EncodedMaps maps = Resized(EncodeMaps(fitted), fine.width, fine.height);
  for (size_t i = 0; i < maps.planes.size(); ++i)
    maps.planes[i] += fine.planes[i] - coarse.planes[i];
  return DecodeMaps(maps);
}

// Deviations of what was fitted from initial maps. Two estimates of one thing, from the same
// photographs, are known no better than they agree: their difference counts beside what the
// estimator expects of its own.
SvbrdfDeviations DeviationsOfFit(SvbrdfDeviations deviations, const SvbrdfMaps& initial,
                                 const SvbrdfMaps& fitted) {
  if (deviations.empty()) return deviations;
  const SvbrdfMaps maps = ResampleSvbrdf(fitted, initial.width, initial.height);
  for (int p = 0; p < kDeviationPlanes; ++p) {
    const int plane = p <= kSigmaNormalY ? p : p + 1;  // deviations have no kNormalZ
    const auto a = initial.plane(plane), b = maps.plane(plane);
    const auto sd = deviations.plane(p);
    for (size_t i = 0; i < sd.size(); ++i) sd[i] = std::hypot(sd[i], a[i] - b[i]);
  }
  return deviations;
}

Json Metrics(const FitResult& fit, const std::vector<RectifiedView>& views) {
  Json levels = Json::array();
  for (const FitLevel& level : fit.levels) {
    levels.push_back({{"width", level.width},
                      {"height", level.height},
                      {"decoder_tuned", level.tuned},
                      {"iterations", level.loss.size()},
                      {"converged", level.converged},
                      {"loss", level.loss}});
  }
  Json losses = Json::array();
  for (size_t i = 0; i < views.size(); ++i) {
    losses.push_back(
        {{"name", views[i].name}, {"photo", views[i].photo}, {"log_l1", fit.view_loss[i]}});
  }
  return {{"start_log_l1", fit.start_loss},
          {"log_l1", fit.final_loss},
          {"levels", levels},
          {"views", losses}};
}

Json Data(const FitResult& fit, const RectifiedSet& set, const FitStageOptions& options,
          const std::vector<RectifiedView>& views) {
  Json names = Json::array();
  for (const RectifiedView& view : views) names.push_back(view.name);
  return {{"convention", ToString(set.convention)},
          {"light_scale_rgb", std::vector<double>(3, fit.light_scale)},
          {"views", names},
          {"metals", options.metals},
          {"method", options.method}};
}

}  // namespace

void AddFitOptions(OptionSet* set, FitStageOptions* options) {
  set->AddChoice("method", &options->method, {"latent", "classic", "initial"},
                 "latent: fit in the auto-encoder's latent space (for a single photograph, keep "
                 "the initial maps, which explain it better, unless --iterations is given); "
                 "classic: fit the maps themselves, texel by texel; initial: the initial maps, "
                 "unfitted");
  set->AddChoice(
      "initial-maps", &options->initial_maps, {"estimator", "rules"},
      "how the initial maps are estimated; estimator: a trained network; rules: lobes fitted "
      "to the whole sample");
  set->AddChoice("metals", &options->metals, {"rare", "possible"},
                 "how dark, glossy areas are interpreted, by the estimator, in refinement and in "
                 "export; rare: glass, lacquer, print and the like; possible: perhaps metal");
  set->AddRange("estimator-size", &options->estimator_size, 0, kFullSize,
                "maximum number of texels along the longer side of the estimator's input; 0: "
                "chosen from the number of photographs and recorded in the manifest");
  set->AddRange(
      "iterations", &options->iterations, 0, 1e6,
      "maximum number of steps at the first, coarse level; 0: the method's default, which "
      "is then recorded in the manifest");
  set->AddRange("fine-iterations", &options->fine_iterations, 0, 1e6,
                "maximum number of steps at each later level; 0: the method's default");
  set->AddRange(
      "finest-size", &options->finest_size, 1, kFullSize,
      "latent: maximum number of texels along the longer side of the finest level; finer detail is "
      "left to refinement, which recovers it equally well from any initial maps");
  set->AddRange("learning-rate", &options->learning_rate, 1e-6, 1,
                "Adam's initial learning rate at each level");
  set->AddRange("tune-iterations", &options->tune_iterations, 0, 1e6,
                "latent: number of steps that fine-tune the decoder to this sample after the "
                "latent code has been fitted");
  set->AddRange("tune-rate", &options->tune_rate, 1e-6, 1,
                "latent: learning rate of the decoder's weights, relative to the latent code's");
  set->AddRange("code-prior", &options->code_prior, 0, 1e6,
                "latent: weight of the penalty on the latent code's magnitude");
  set->Add("start", &options->start,
           "initial maps, an svbrdf.exr file (default: estimated from the photographs)");
  set->Add("weights", &options->weights, "the auto-encoder's weights (default: the shipped ones)");
  set->Add("estimator", &options->estimator, "the estimator's weights (default: the shipped ones)");
  set->Add("views", &options->views,
           "views to use, by view name or photograph name (default: all)");
  set->Add("exclude", &options->exclude, "views to hold out, by view name or photograph name");
}

void ResolveFitOptions(const fs::path& rectify_manifest, FitStageOptions* options) {
  const RectifiedSet set = ReadRectifiedSet(rectify_manifest);
  const size_t photographs = SelectViews(set, options->views, options->exclude).size();
  if (options->estimator_size == 0) {
    options->estimator_size =
        photographs <= kFewPhotographs ? kMostEstimatorSize : Estimator::kGlobalSize;
  }
  // From one photograph roughness and specular drift along ambiguities while the loss falls
  // (docs/experiments/one-photograph.md): no step is best.
  if (IsLatent(*options) && photographs == 1 && options->iterations == 0)
    options->method = "initial";
  if (options->method == "initial") return;  // without iterations
  FitOptions own = IsLatent(*options) ? FitOptions::Latent() : FitOptions::Classic();
  if (IsLatent(*options) && photographs > kFewPhotographs) own = FitOptions::LatentForRefinement();
  if (options->iterations == 0) options->iterations = own.coarse_iterations;
  if (options->fine_iterations == 0) options->fine_iterations = own.fine_iterations;
}

std::vector<fs::path> FitInputs(const FitStageOptions& options) {
  std::vector<fs::path> inputs;
  if (IsLatent(options)) {
    inputs.push_back(AsUserError([&] { return FindModel(kAutoencoderModel, options.weights); }));
  }
  if (!options.start.empty()) {
    inputs.push_back(options.start);
  } else if (Estimates(options)) {
    inputs.push_back(EstimatorWeights(options));
  }
  return inputs;
}

namespace {

// What was fitted to which views.
struct Fitted {
  Initial initial;
  FitResult fit;
  std::vector<RectifiedView> views;
};

FitResult FitFrom(const Initial& initial, const PhotographSet& photographs,
                  const FitStageOptions& options, const FitOptions& fit_options) {
  if (options.method == "initial") return KeepStart(photographs, initial.maps, fit_options.threads);
  std::unique_ptr<Progress> bar;
  const FitProgress progress = [&](int done, int total, double loss) {
    if (bar == nullptr) bar = std::make_unique<Progress>("fit", total);
    bar->Set(done, "log-L1 " + std::to_string(loss));
  };
  if (!IsLatent(options)) return FitClassic(photographs, initial.maps, fit_options, progress);
  const Autoencoder network =
      AsUserError([&] { return Autoencoder::Load(FindModel(kAutoencoderModel, options.weights)); });
  FitResult fit = FitLatent(photographs, initial.maps, network, fit_options, progress);
  fit.maps = WithDetail(fit.maps, initial.maps);
  return fit;
}

Fitted FitTo(const RectifiedSet& set, std::vector<RectifiedView> views,
             const FitStageOptions& options, const FitOptions& fit_options) {
  const int threads = fit_options.threads;
  const Size fitted = FittedSize(set.plane, options, fit_options);
  const Size shown = ShownSize(set.plane, options, fit_options);
  PhotographSet photographs = Load(set, views, fitted, shown, threads);
  const EstimatorConditions conditions{options.metals == "rare", set.light_power_known};
  Initial initial = InitialMaps(
      options, Downsampled(photographs, shown.first, shown.second, threads), conditions, threads);
  photographs = WithPower(Downsampled(photographs, fitted.first, fitted.second, threads),
                          initial.power.factor);
  FitResult fit = FitFrom(initial, photographs, options, fit_options);
  fit.light_scale *= initial.power.factor;
  return {std::move(initial), std::move(fit), std::move(views)};
}

std::vector<LeftOutView> OddViewsOf(const Fitted& fitted, const RectifiedSet& set,
                                    const FitStageOptions& options) {
  std::vector<LeftOutView> odd;
  if (set.fixed_camera || !IsLatent(options) || !options.views.empty()) return odd;
  for (const size_t i : OddViews(fitted.fit.view_loss, kOddOfFitted)) {
    odd.push_back({fitted.views[i].name, fitted.views[i].photo, fitted.fit.view_loss[i]});
  }
  return odd;
}

Json JsonOf(const std::vector<LeftOutView>& left_out) {
  Json json = Json::array();
  for (const LeftOutView& view : left_out) {
    json.push_back({{"name", view.name}, {"photo", view.photo}, {"log_l1", view.log_l1}});
  }
  return json;
}

}  // namespace

FitStageResult RunFitStage(const fs::path& rectify_manifest, const FitStageOptions& options,
                           int threads, Stage* stage) {
  const RectifiedSet set = ReadRectifiedSet(rectify_manifest);
  std::vector<RectifiedView> views = SelectViews(set, options.views, options.exclude);
  const FitOptions fit_options = FitOptionsOf(options, threads);
  if (const std::string wrong = fit_options.Check(); !wrong.empty())
    throw UserError("fit: " + wrong);
  const auto began = std::chrono::steady_clock::now();
  // Sixteen of a fixed camera's lights give as good initial maps as all; refinement uses all.
  Fitted fitted =
      FitTo(set, set.fixed_camera ? SpreadViews(views, kMostLights) : views, options, fit_options);
  FitStageResult result;
  result.left_out = OddViewsOf(fitted, set, options);
  for (const LeftOutView& odd : result.left_out) {
    std::erase_if(views, [&](const RectifiedView& view) { return view.name == odd.name; });
  }
  if (!result.left_out.empty()) fitted = FitTo(set, views, options, fit_options);
  result.fit = std::move(fitted.fit);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result.width = set.plane.width;
  result.height = set.plane.height;
  result.data = Data(result.fit, set, options, views);
  result.metrics = Metrics(result.fit, fitted.views);
  result.metrics["left_out"] = JsonOf(result.left_out);
  const Initial& initial = fitted.initial;
  if (Estimates(options) && !set.light_power_known) {
    result.metrics["light_power"] = {{"factor", initial.power.factor},
                                     {"log_l1", initial.power.log_l1},
                                     {"log_l1_as_given", initial.power.as_given}};
  }
  WriteAtSize(stage->Output("svbrdf.exr"), result.fit.maps, set);
  if (!initial.deviations.empty()) {
    WriteDeviations(stage->Output("confidence.exr"),
                    DeviationsOfFit(initial.deviations, initial.maps, result.fit.maps),
                    set.plane.width, set.plane.height, set.convention);
  }
  stage->Commit(result.data, result.metrics);
  return result;
}

}  // namespace glint
