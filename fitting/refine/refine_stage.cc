#include "fitting/refine/refine_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/files/memory_limit.h"
#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_rows.h"
#include "base/parallel/parallel.h"
#include "base/programs/progress.h"
#include "base/reflectance/brdf.h"
#include "base/reflectance/material_kinds.h"
#include "fitting/photographs/odd_views.h"
#include "fitting/refine/estimate_sample.h"
#include "fitting/refine/held_out_exposures.h"
#include "fitting/refine/light_power.h"
#include "fitting/refine/refine_metrics.h"
#include "fitting/refine/refine_rows.h"
#include "fitting/refine/residual_model.h"
#include "fitting/refine/row_reader.h"
#include "fitting/refine/sample_source.h"
#include "fitting/refine/substances.h"
#include "fitting/refine/view_sharpness.h"
#include "fitting/view_correction/corrections_json.h"
#include "fitting/view_correction/shared_light.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// In the order of ConfidencePlane.
const std::vector<std::string>& ConfidenceChannels() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> channels = DeviationChannels();
    channels.emplace_back("cost.Y");
    return channels;
  }();
  return names;
}

constexpr char kMapsFile[] = "svbrdf.exr", kConfidenceFile[] = "confidence.exr";

// Of the stage's time, at the paper's twenty views: lights and pictures are found on a sample.
constexpr double kViewsShare = 0.3;

std::vector<RectifiedView> ChooseViews(const RectifiedSet& set, const RefineStart& start,
                                       const RefineStageOptions& options) {
  const std::vector<std::string>& only = options.views.empty() ? start.views : options.views;
  return SelectViews(set, only, options.exclude);
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
  Json metrics = FieldsOf(summary, TexelMetrics());
  metrics.update(FieldsOf(summary, SampleMetrics()));
  metrics["log_l1"] = usable > 0 ? sum / usable : 0.0;
  metrics["views"] = losses;
  return metrics;
}

// Lamps that a fixed camera saw differ in what they show.
Json OddViewsOf(const RefineSummary& summary, const RectifiedSet& set,
                const std::vector<RectifiedView>& views) {
  Json odd = Json::array();
  if (set.fixed_camera) return odd;
  for (const size_t i : OddViews(summary.view_loss, kOddOfRefined)) odd.push_back(views[i].name);
  return odd;
}

// Views whose blur hides detail that sharper ones show.
Json BlurredViewsOf(const PhotographSet& said, double residual_sigma,
                    const std::vector<RectifiedView>& views) {
  RefineProblem problem = ProblemOf(said);
  WeighViews(residual_sigma * residual_sigma, &problem);
  Json blurred = Json::array();
  for (size_t v = 0; v < views.size(); ++v) {
    const RefineView& view = problem.views[v];
    if (view.hidden_variance == 0) continue;
    blurred.push_back({{"name", views[v].name},
                       {"photo", views[v].photo},
                       {"hidden_detail", std::sqrt(view.hidden_variance)},
                       {"weight", view.weight}});
  }
  return blurred;
}

// What each view is to be corrected by: what was found before refinement and, beside it, the views'
// deviations that refinement found. Empty: nothing.
std::vector<ViewCorrection> Corrections(const CorrectionResult& found,
                                        const RefineSummary& summary) {
  std::vector<ViewCorrection> corrections(summary.exposures.size());
  if (found.taken) corrections = found.corrections.views;
  bool any = found.taken;
  for (size_t v = 0; v < corrections.size(); ++v) {
    ViewCorrection deviation;
    deviation.light_offset_mm = summary.light_offsets_mm[v];
    deviation.exposure = summary.exposures[v];
    any = any || !deviation.none();
    for (size_t i = 0; i < 3; ++i) {
      corrections[v].light_offset_mm[i] += deviation.light_offset_mm[i];
    }
    corrections[v].exposure *= deviation.exposure;
  }
  return any ? corrections : std::vector<ViewCorrection>();
}

// data.corrections, by view.
void AddCorrections(const std::vector<ViewCorrection>& corrections,
                    const std::vector<RectifiedView>& views, Json* data) {
  if (corrections.empty()) return;
  Json entries = Json::array();
  for (size_t i = 0; i < views.size(); ++i) {
    entries.push_back(JsonOf(views[i].name, corrections[i]));
  }
  (*data)["corrections"] = entries;
}

// What was found and taken before refinement: environment lighting, and the corrections' sizes.
// `light_scale_rgb`: of the views' power, as the fit found it.
void DescribeCorrection(const CorrectionResult& found, const RectifiedSet& set,
                        const std::vector<RectifiedView>& views, const Vec3d& light_scale_rgb,
                        RefineStageResult* result) {
  result->metrics["correction"] = {
      {"taken", found.taken}, {"cost_before", found.cost_before}, {"cost_after", found.cost_after}};
  if (!found.taken) return;
  double turned_deg = 0, shifted = 0;
  bool moved = false;
  for (size_t i = 0; i < views.size(); ++i) {
    const ViewCorrection& c = found.corrections.views[i];
    turned_deg += LightTurnedDeg(views[i].view, c) / static_cast<double>(views.size());
    shifted += c.shifts.rms() / static_cast<double>(views.size());
    moved = moved || !c.none();
  }
  result->data["room_light"] = JsonOf(found.corrections.environment);
  const Vec3d ambient = found.corrections.environment.PlaneIrradiance();
  const TexelGeometry<double> centre =
      TexelGeometryInView(views[0].view, set.convention.falloff, 0.0, 0.0);
  double flash = 0, environment = 0;
  for (size_t k = 0; k < 3; ++k) {
    flash += light_scale_rgb[k] * centre.irradiance[k] / views[0].view.exposure;
    environment += ambient[k];
  }
  result->metrics["correction"].update({{"systematic_sd", JsonOf(found.corrections.systematic_sd)},
                                        {"views_moved", moved},
                                        {"light_turned_deg", turned_deg},
                                        {"registration_texel", shifted},
                                        {"ambient_of_flash", environment / flash}});
}

CorrectionResult CorrectViewsWithBar(const RefineOptions& refine, const CorrectionOptions& options,
                                     int threads, SampleSource* source) {
  if (!options.Wanted(DistinctViews(ProblemOf(source->Views())))) return {};
  const SamplePlane& plane = source->plane();
  const auto [width, height] = options.WorkingSize(plane);
  const SampleSource::Part small = source->Downsampled(width, height, threads);
  std::unique_ptr<Progress> bar;
  CorrectionResult found = FindCorrections(
      small.photographs, small.start, refine, options, threads,
      [&](std::int64_t done, std::int64_t total) {
        if (!bar) bar = std::make_unique<Progress>("views", total, Progress::Part{0, kViewsShare});
        bar->Set(done);
      });
  found.corrections = AtSize(found.corrections, width, height, plane.width, plane.height);
  return found;
}

SampleEstimate EstimateFrom(const RefineOptions& options, int threads, SampleSource* source) {
  const int stride = EstimationStride(source->plane(), options.estimation_size);
  const SampleSource::Part part = source->Every(stride, threads);
  return EstimateSample(part.Problem(), part.start, options, threads);
}

// How many rows are refined at a time: as the memory that they need allows.
int RowsAtOnce(const SamplePlane& plane, size_t views) {
  constexpr double kMostBytes = 1e9, kShareOfLimit = 0.25;
  // Of a texel: a photograph's colour and mask, what is shifted of it or read ahead, its colour
  // without blur; maps at the start, between steps (twice, copied as they are read and written) and
  // in the end, relief, confidence, substances.
  const double texel_bytes = 32.0 * static_cast<double>(views) + 400;
  const double bytes =
      std::min(kMostBytes, kShareOfLimit * static_cast<double>(MemoryLimit_bytes()));
  return static_cast<int>(std::clamp(bytes / texel_bytes / plane.width, 16.0, 1e9));
}

// What is expected of views whose light nobody calibrated, and of those that were stored encoded.
RefineOptions OptionsFor(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                         const RefineStart& start, const RefineStageOptions& options) {
  RefineOptions refine = options.refine;
  refine.kinds.metal_share = MetalShareOf(start.metals);
  if (!set.light_power_known) refine.kinds.light_power_spread = options.light_power_spread;
  const bool encoded = std::all_of(views.begin(), views.end(),
                                   [](const RectifiedView& view) { return view.encoded(); });
  if (encoded && !set.fixed_camera) refine.toe = options.toe;
  if (set.light_power_known && !set.fixed_camera) return refine;
  refine.exposure_spread = options.exposure_spread;
  refine.residual_sigma = options.residual_sigma;
  // Directions are those that were measured, on a dome or a ball; lamps differ in strength.
  if (set.fixed_camera) {
    refine.level_spread = options.level_spread;
    refine.lamp_gradient = options.lamp_gradient;
    return refine;
  }
  refine.flash_offset = options.flash_offset;
  refine.light_spread = options.light_spread;
  refine.flash_beam = options.flash_beam;
  refine.distance_power = options.distance_power;
  if (encoded) refine.shoulder = options.shoulder;
  return refine;
}

// A flash that was measured stands where it was found, to the accuracy that is stated.
CorrectionOptions CorrectionFor(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                                CorrectionOptions options) {
  // Nothing moved but the light, to its stated place: only ambient illumination is left to find.
  if (set.fixed_camera) {
    if (options.when == "auto") options.when = "never";
    options.view.light = options.view.registration = false;
  }
  if (!set.light_sd_mm) return options;
  std::vector<View> said(views.size());
  std::transform(views.begin(), views.end(), said.begin(),
                 [](const RectifiedView& view) { return view.view; });
  ViewExpectations& expected = options.view.expected;
  expected.light = expected.distance = expected.shared_light =
      *set.light_sd_mm / MeanLightDistance_mm(said);
  return options;
}

// Of the light beside what is stated, as the substances' specular albedos tell it: 1 where it was
// calibrated, or where ambient illumination, which is not scaled with it, lights the sample too.
double LightPower(const RectifiedSet& set, const std::vector<RectifiedView>& views,
                  const SampleEstimate& estimate) {
  const bool dark = std::all_of(views.begin(), views.end(), [](const RectifiedView& view) {
    return view.view.ambient_rgb == Vec3d{};
  });
  return set.light_power_known || !dark ? 1 : estimate.summary.light_power;
}

// A capture's sample, ready to be refined by rows.
struct Sample {
  Sample(const fs::path& rectify_manifest, const RefineStart& start,
         const RefineStageOptions& stage_options, int threads)
      : set(ReadRectifiedSet(rectify_manifest)),
        views(ChooseViews(set, start, stage_options)),
        options(OptionsFor(set, views, start, stage_options)),
        source(set, views, start.light_scale_rgb, start.maps_file, start.deviations_file),
        correction(CorrectViewsWithBar(options, CorrectionFor(set, views, stage_options.correction),
                                       threads, &source)),
        rows_at_once(stage_options.rows_at_once > 0 ? stage_options.rows_at_once
                                                    : RowsAtOnce(set.plane, views.size())),
        estimate(EstimateCorrected(threads)) {}

  RectifiedSet set;
  std::vector<RectifiedView> views;
  RefineOptions options;
  SampleSource source;
  CorrectionResult correction;
  int rows_at_once;
  SampleEstimate estimate;

  double power() const { return LightPower(set, views, estimate); }

 private:
  SampleEstimate EstimateCorrected(int threads) {
    if (correction.taken) source.Correct(correction.corrections);
    if (set.fixed_camera) {
      source.MaskShadows(threads);
    } else {
      source.CompareSharpness(options, threads);
    }
    return EstimateFrom(options, threads, &source);
  }
};

// Of the maps: that of the initial ones, with the lobes that the photographs asked for, under a
// light of `power`.
ReflectanceConvention ConventionOf(const SampleEstimate& estimate, double power,
                                   ReflectanceConvention convention) {
  convention.lobes = estimate.summary.lobes;
  convention.lobes.coat_f0 /= power;
  return convention;
}

// A fixed camera's photographs have a light of their own each, held-out ones too.
void AddHeldOut(const Sample& sample, const fs::path& maps_file, const Vec3d& light_scale_rgb,
                int threads, Json* data) {
  if (!sample.set.fixed_camera) return;
  std::vector<RectifiedView> others;
  for (const RectifiedView& view : sample.set.views) {
    const bool fitted = std::any_of(sample.views.begin(), sample.views.end(),
                                    [&](const auto& other) { return other.name == view.name; });
    if (!fitted) others.push_back(view);
  }
  if (others.empty()) return;
  SampleSource source(sample.set, others, light_scale_rgb, maps_file, {});
  const std::vector<double> exposures = HeldOutExposures(&source, threads);
  Json& entries = (*data)["corrections"];
  if (entries.is_null()) entries = Json::array();
  for (size_t i = 0; i < others.size(); ++i) {
    ViewCorrection correction;
    correction.exposure = exposures[i];
    entries.push_back(JsonOf(others[i].name, correction));
    entries.back()["held_out"] = true;
  }
}

// Writes the part's rows of svbrdf.exr and confidence.exr, albedos as under a light of `power`.
RowSums RefineRows(const RowPart& part, const SampleEstimate& estimate,
                   const RefineOptions& options, double power, int rows_at_once, int threads,
                   SampleSource* source, Stage* stage) {
  const SamplePlane& plane = source->plane();
  const ReflectanceConvention convention =
      ConventionOf(estimate, power, source->Views().convention);
  const RowSpan rows{part.first(plane.height), part.last(plane.height)};
  std::unique_ptr<Progress> bar;
  const RowRefiner::ReportProgress progress = [&](std::int64_t done, std::int64_t total) {
    if (!bar) bar = std::make_unique<Progress>("refine", total, Progress::Part{kViewsShare, 1});
    bar->Set(done);
  };
  SvbrdfWriter maps(stage->Output(kMapsFile), plane.width, rows.size(), convention);
  ExrWriter confidence(stage->Output(kConfidenceFile), plane.width, rows.size(),
                       ConfidenceChannels(), {{"convention", ToString(convention)}},
                       ExrPrecision::kHalf);
  const fs::path scratch = rows_at_once < plane.height ? stage->StagedOutput("") : fs::path();
  RowRefiner refiner(estimate, options, ProblemOf(source->Views()), rows, scratch, threads,
                     progress);
  RowReader reader(source, rows_at_once, threads);
  const auto write = [&](RowRefiner::Rows refined) {
    SetUnderPower(power, convention.diffuse_weight, &refined.maps, &refined.confidence);
    Image deviations(plane.width, refined.maps.height, {});
    deviations.channels = ConfidenceChannels();
    deviations.samples = std::move(refined.confidence);
    // Compressing takes as long as reading the photographs.
    ForEachPiece(2, threads, [&](int file) {
      file == 0 ? maps.Write(refined.maps) : confidence.Write(deviations);
    });
  };
  for (int step = 0; step < refiner.steps(); ++step) {
    reader.ForEach(step, &refiner, [&] {
      if (auto refined = refiner.Do(step)) write(std::move(*refined));
    });
  }
  maps.Close();
  confidence.Close();
  return refiner.sums();
}

// What parts of a sample must agree on: a hash of what was estimated of it as a whole. It differs
// between processors with different vector units.
std::string EstimateHash(const Sample& sample) {
  const RefineSummary& summary = sample.estimate.summary;
  Json json = FieldsOf(summary, SampleMetrics());
  // Not part of it: parts that builds of this stage version made must go on fitting together.
  for (const char* field : {"model_discrepancy", "effective_views", "substances"}) {
    json.erase(field);
  }
  json.update({{"shared_light", JsonOf(summary.shared_light)},
               {"room_light", JsonOf(sample.correction.corrections.environment)},
               {"systematic_sd", JsonOf(sample.correction.corrections.systematic_sd)}});
  AddCorrections(Corrections(sample.correction, summary), sample.views, &json);
  return HashBytes(json.dump());
}

void RequireSameEstimate(const fs::path& folder, const std::string& hash) {
  const fs::path file = folder / "manifest.json";
  if (RequireString(file, ReadManifest(file).data, "data", "estimate") == hash) return;
  throw UserError(file, "data.estimate", "another estimate of the sample than on this machine",
                  "join parts on a processor with the vector instructions of those that made them");
}

// The same of results of parts, in their folders.
RowSums JoinParts(const std::vector<fs::path>& folders, const Sample& sample, Stage* stage) {
  const SampleEstimate& estimate = sample.estimate;
  const SamplePlane& plane = sample.set.plane;
  const std::string hash = EstimateHash(sample);
  for (const fs::path& folder : folders) RequireSameEstimate(folder, hash);
  for (const char* name : {kMapsFile, kConfidenceFile}) {
    std::vector<fs::path> files;
    files.reserve(folders.size());
    for (const fs::path& folder : folders) files.push_back(folder / name);
    JoinRows(files, plane.height, sample.rows_at_once, stage->Output(name));
  }
  RowSums sums;
  for (size_t i = 0; i < folders.size(); ++i) {
    const RowPart part{static_cast<int>(i) + 1, static_cast<int>(folders.size())};
    const RowSums some =
        ReadRowSums(folders[i] / kPartSums, part.last(plane.height) - part.first(plane.height),
                    RowSumColumns(estimate.order.size()));
    sums.insert(sums.end(), some.begin(), some.end());
  }
  return sums;
}

}  // namespace

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
  start.maps_file = work / "fit" / kMapsFile;
  const bool stated = std::any_of(fit.outputs.begin(), fit.outputs.end(), [](const auto& output) {
    return output.path == kConfidenceFile;
  });
  if (stated) start.deviations_file = work / "fit" / kConfidenceFile;
  if (fit.data.contains("light_scale_rgb")) {
    const auto scale = RequireNumbers(file, fit.data, "data", "light_scale_rgb", 3);
    std::copy(scale.begin(), scale.end(), start.light_scale_rgb.begin());
  }
  start.metals = MetalsOf(file, fit);
  const Json& views = RequireField(file, fit.data, "data", "views");
  const auto is_name = [](const Json& name) { return name.is_string(); };
  if (!views.is_array() || !std::all_of(views.begin(), views.end(), is_name)) {
    throw UserError(file, "data.views", views.dump(), "run glint-fit again");
  }
  for (const Json& name : views) start.views.push_back(name.get<std::string>());
  return start;
}

RefineStageResult RunRefineStage(const fs::path& rectify_manifest, const RefineStart& start,
                                 const RefineStageOptions& options,
                                 const std::vector<fs::path>& parts, int threads, Stage* stage) {
  const auto began = std::chrono::steady_clock::now();
  Sample sample(rectify_manifest, start, options, threads);
  const SamplePlane& plane = sample.set.plane;
  const RowSums sums = parts.empty()
                           ? RefineRows({}, sample.estimate, sample.options, sample.power(),
                                        sample.rows_at_once, threads, &sample.source, stage)
                           : JoinParts(parts, sample, stage);
  RefineStageResult result;
  result.correction = std::move(sample.correction);
  result.summary = Summarise(sample.estimate, sums, plane.width);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result.width = plane.width;
  result.height = plane.height;
  for (const RectifiedView& view : sample.views) result.views.push_back(view.name);
  Vec3d light_scale_rgb = start.light_scale_rgb;
  for (double& scale : light_scale_rgb) scale *= sample.power();
  const ReflectanceConvention convention =
      ConventionOf(sample.estimate, sample.power(), sample.source.Views().convention);
  result.data = {{"convention", ToString(convention)},
                 {"light_scale_rgb", light_scale_rgb},
                 {"shared_light", JsonOf(result.summary.shared_light)},
                 {"views", result.views},
                 {"metals", start.metals},
                 {"method", "refined"}};
  result.metrics = Metrics(result.summary, sample.views);
  result.metrics["odd_views"] = OddViewsOf(result.summary, sample.set, sample.views);
  result.metrics["blurred_views"] =
      BlurredViewsOf(sample.source.Views(), result.summary.residual_sigma, sample.views);
  result.metrics["light_power"] = {{"factor", sample.power()}};
  result.metrics["narrow_lobe"] = JsonOf(convention.lobes);
  AddCorrections(Corrections(result.correction, result.summary), sample.views, &result.data);
  AddHeldOut(sample, stage->StagedOutput(kMapsFile), light_scale_rgb, threads, &result.data);
  DescribeCorrection(result.correction, sample.set, sample.views, start.light_scale_rgb, &result);
  stage->Commit(result.data, result.metrics);
  return result;
}

RowRange RunRefinePart(const fs::path& rectify_manifest, const RefineStart& start,
                       const RefineStageOptions& options, const RowPart& part, int threads,
                       Stage* stage) {
  const int height = ReadRectifiedSet(rectify_manifest).plane.height;
  if (part.of > height) {
    throw UserError("--part: found " + std::to_string(part.of) + " parts; the maps have " +
                    std::to_string(height) + " rows, so that many at most");
  }
  Sample sample(rectify_manifest, start, options, threads);
  const RowSums sums = RefineRows(part, sample.estimate, sample.options, sample.power(),
                                  sample.rows_at_once, threads, &sample.source, stage);
  WriteRowSums(stage->Output(kPartSums), sums);
  const RowRange range{part.first(height), part.last(height) - part.first(height), height};
  stage->Commit(
      {{"first_row", range.first}, {"rows", range.rows}, {"estimate", EstimateHash(sample)}},
      Json::object());
  return range;
}

}  // namespace glint
