#include "fitting/refine/refine_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "pipeline/contract/errors.h"
#include "pipeline/contract/image.h"
#include "pipeline/contract/progress.h"
#include "pipeline/contract/rectified_set.h"
#include "pipeline/contract/svbrdf_file.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// In the order of ConfidencePlane.
const std::vector<std::string> kConfidenceChannels = {
    "normal.X",   "normal.Y",   "diffuse.R",  "diffuse.G",   "diffuse.B",
    "specular.R", "specular.G", "specular.B", "roughness.Y", "cost.Y"};

std::vector<RectifiedView> ChooseViews(const RectifiedSet& set, const RefineStart& start,
                                       const RefineStageOptions& options) {
  const std::vector<std::string>& only = options.views.empty() ? start.views : options.views;
  return SelectViews(set, only, options.exclude);
}

// The photographs in memory, as the problem's spans see them.
struct LoadedPhotographs {
  std::vector<RectifiedImage> images;
  RefineProblem problem;
};

LoadedPhotographs Load(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                       const ReflectanceConvention& convention, const Vec3d& light_scale_rgb) {
  LoadedPhotographs loaded;
  loaded.images.reserve(views.size());
  loaded.problem.plane = set.plane;
  loaded.problem.convention = convention;
  for (const RectifiedView& view : views) {
    loaded.images.push_back(ReadRectifiedImage(set, view));
    AdmitClippedTexels(view, &loaded.images.back());
    const RectifiedImage& image = loaded.images.back();
    RefineView& added = loaded.problem.views.emplace_back();
    added.view = view.view;
    for (int c = 0; c < 3; ++c) added.view.light_rgb[c] *= light_scale_rgb[c];
    added.ldr = view.ldr;
    added.rgb = image.rgb;
    added.mask = image.mask;
  }
  return loaded;
}

Json Metrics(const RefineSummary& summary, const std::vector<RectifiedView>& views) {
  Json losses = Json::array();
  double sum = 0.0;
  int usable = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    const double loss = summary.view_loss[i];
    Json entry = {{"name", views[i].name}, {"photo", views[i].photo}};
    if (std::isfinite(loss)) {
      entry["log_l1"] = loss;
      sum += loss;
      ++usable;
    } else {
      entry["log_l1"] = nullptr;  // wholly masked
    }
    losses.push_back(entry);
  }
  return {{"cost_before", summary.start_cost},
          {"cost_after", summary.final_cost},
          {"converged", summary.converged},
          {"from_other_start", summary.other_start},
          {"from_neighbour", summary.neighbour},
          {"residual_sigma", summary.residual_sigma},
          {"distinct_views", summary.distinct_views},
          {"log_l1", usable > 0 ? sum / usable : 0.0},
          {"views", losses}};
}

Image ConfidenceImage(const RefineResult& result) {
  Image image(result.maps.width, result.maps.height, kConfidenceChannels);
  image.samples = result.confidence;
  return image;
}

}  // namespace

void AddRefineOptions(OptionSet* set, RefineStageOptions* options) {
  RefineOptions* refine = &options->refine;
  set->AddRange("iterations", &refine->iterations, 1, 1000,
                "most Levenberg-Marquardt steps of one solve");
  set->AddRange("starts", &refine->starts, 1, 8,
                "solves per texel: the start, and so many less one of other roughness");
  set->AddRange("neighbour-passes", &refine->neighbour_passes, 0, 16,
                "how often a texel tries its neighbours' solutions");
  set->AddRange("prior", &refine->prior, 0, 1e6,
                "factor on the weight that holds texels to their start; 0: none");
  set->AddRange("robust-scale", &refine->robust_scale, 1e-3, 100,
                "residuals (logarithms) beyond it count linearly");
  set->Add("views", &options->views, "views to use, by name or photo (default: those of fit)");
  set->Add("exclude", &options->exclude, "views to keep back, by name or photo");
  set->Add("from", &options->from, "maps to start from, an svbrdf.exr (default: the fit's)");
}

RefineStart ResolveRefineStart(const fs::path& work, const RefineStageOptions& options) {
  const std::string wrong = options.refine.Check();
  if (!wrong.empty()) throw UserError("refine: " + wrong);
  RefineStart start;
  if (!options.from.empty()) {
    start.maps_file = options.from;
    return start;
  }
  start.manifest_file = work / "fit" / "manifest.json";
  const fs::path& file = start.manifest_file;
  const Manifest fit = ReadManifest(file, "fit");
  VerifyOutputs(file, fit);
  start.maps_file = work / "fit" / "svbrdf.exr";
  if (fit.data.contains("light_scale_rgb")) {
    const auto scale = RequireNumbers(file, fit.data, "data", "light_scale_rgb", 3);
    std::copy(scale.begin(), scale.end(), start.light_scale_rgb.begin());
  }
  const Json& views = RequireField(file, fit.data, "data", "views");
  const auto is_name = [](const Json& name) { return name.is_string(); };
  if (!views.is_array() || !std::all_of(views.begin(), views.end(), is_name)) {
    throw UserError(file, "data.views", views.dump(), "run glint-fit again");
  }
  for (const Json& name : views) start.views.push_back(name.get<std::string>());
  return start;
}

RefineStageResult RunRefineStage(const fs::path& rectify_manifest, const RefineStart& start,
                                 const RefineStageOptions& options, int threads, Stage* stage) {
  const RectifiedSet set = ReadRectifiedSet(rectify_manifest);
  ReflectanceConvention convention = set.convention;
  ReflectanceConvention of_maps;
  SvbrdfMaps maps = ReadSvbrdf(start.maps_file, &of_maps);
  convention.diffuse_weight = of_maps.diffuse_weight;
  if (maps.width != set.plane.width || maps.height != set.plane.height) {
    maps = ResampleSvbrdf(maps, set.plane.width, set.plane.height);
  }
  const std::vector<RectifiedView> views = ChooseViews(set, start, options);
  const LoadedPhotographs loaded = Load(set, views, convention, start.light_scale_rgb);

  const auto began = std::chrono::steady_clock::now();
  RefineResult refined;
  {
    std::unique_ptr<Progress> bar;
    refined = Refine(loaded.problem, maps, options.refine, threads,
                     [&](std::int64_t done, std::int64_t total) {
                       if (!bar) bar = std::make_unique<Progress>("refine", total);
                       bar->Set(done);
                     });
  }
  RefineStageResult result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result.summary = refined.summary;
  result.width = maps.width;
  result.height = maps.height;
  for (const RectifiedView& view : views) result.views.push_back(view.name);

  WriteSvbrdf(stage->Output("svbrdf.exr"), refined.maps, convention);
  WriteExr(stage->Output("confidence.exr"), ConfidenceImage(refined),
           {{"convention", ToString(convention)}});
  result.data = {{"convention", ToString(convention)},
                 {"light_scale_rgb", start.light_scale_rgb},
                 {"views", result.views},
                 {"method", "refined"}};
  result.metrics = Metrics(refined.summary, views);
  stage->Commit(result.data, result.metrics);
  return result;
}

}  // namespace glint
