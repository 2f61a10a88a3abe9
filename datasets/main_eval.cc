// glint-eval: how good results are.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <tuple>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/calibration.h"
#include "base/formats/capture.h"
#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_file.h"
#include "base/programs/verbs.h"
#include "datasets/evaluation/calibration_error.h"
#include "datasets/evaluation/experiment_verbs.h"
#include "datasets/evaluation/holdout_verb.h"
#include "datasets/evaluation/light_verb.h"
#include "datasets/evaluation/limits_verb.h"
#include "datasets/evaluation/map_error.h"
#include "datasets/evaluation/predicted_deviation.h"
#include "datasets/evaluation/relight_verb.h"
#include "datasets/evaluation/tiling_verb.h"
#include "datasets/looks/looks_figures.h"
#include "datasets/looks/view_error.h"
#include "datasets/synth/material_source.h"

namespace {

using namespace glint;
namespace fs = std::filesystem;

constexpr int kPaperSize = 256;  // texels a side of the paper's materials

// Maps of any layout with diffuse weight 1; of a result also by its manifest; procedural ones at
// `procedural_size`.
SvbrdfMaps ReadAnyMaps(const fs::path& path, int procedural_size) {
  if (path.extension() == ".exr" || path.filename() == "manifest.json") {
    const FittedMaps result = ReadFittedMaps(path);
    return ToUnitWeight(result.maps, result.convention);
  }
  const bool procedural = path.string().starts_with("procedural:");
  return LoadMaterial(path.string(), procedural ? procedural_size : 0).maps;
}

ProgramResult ReportMaps(const Table1Row& row, bool resampled) {
  const MapErrors& maps = row.maps;
  ProgramResult result;
  result.json = {{"diffuse", maps.diffuse},        {"specular", maps.specular},
                 {"roughness", maps.roughness},    {"normal", maps.normal},
                 {"map_average", maps.average()},  {"render", row.render},
                 {"estimate_resampled", resampled}};
  result.text = fmt::format(
      "mean squared error, maps on [0, 1]\n"
      "diffuse      {:.6f}\nspecular     {:.6f}\nroughness    {:.6f}\nnormal       {:.6f}\n"
      "map average  {:.6f}\nrender       {:.6f}   ({} novel views and lights, clipped to [0, 1])\n",
      maps.diffuse, maps.specular, maps.roughness, maps.normal, maps.average(), row.render,
      kNovelViews);
  if (resampled) result.text += "the estimate was resampled to the size of the ground truth\n";
  return result;
}

// How often the truth lies within the deviations that refinement states: 68 and 95 % of normal
// ones.
void ReportCoverage(const SvbrdfMaps& maps, const SvbrdfMaps& truth, const StatedDeviations& stated,
                    ProgramResult* result) {
  result->text +=
      "ground truth within the stated standard deviations (normal, diffuse, specular, roughness)\n";
  for (const auto& [name, percent, widths] :
       {std::tuple{"coverage_68", 68, 1.0}, std::tuple{"coverage_95", 95, 1.96}}) {
    const Coverage share = CoverageOf(maps, truth, stated, widths);
    result->json[name] = {{"normal", share.normal},
                          {"diffuse", share.diffuse},
                          {"specular", share.specular},
                          {"roughness", share.roughness}};
    result->text += fmt::format("{} % interval   {:6.3f} {:6.3f} {:6.3f} {:6.3f}\n", percent,
                                share.normal, share.diffuse, share.specular, share.roughness);
  }
}

int RunMaps(int argc, char** argv, const ProgramInfo& info) {
  fs::path estimate_path, truth_path;
  OptionSet options;
  options.AddPositional("estimate", &estimate_path,
                        "estimated maps: svbrdf.exr, manifest.json, strip or folder", true);
  options.AddPositional("truth", &truth_path,
                        "ground-truth maps: svbrdf.exr, manifest.json, strip or folder", true);
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    SvbrdfMaps estimate = ReadAnyMaps(estimate_path, kPaperSize);
    const SvbrdfMaps truth = ReadAnyMaps(truth_path, estimate.width);
    const bool resample = estimate.width != truth.width || estimate.height != truth.height;
    if (resample) estimate = ResampleSvbrdf(estimate, truth.width, truth.height);
    ProgramResult result = ReportMaps(EvaluateMaps(estimate, truth, common.threads), resample);
    const fs::path manifest = estimate_path.parent_path() / "manifest.json";
    if (!resample && fs::exists(manifest)) {
      if (const auto stated = ReadStatedDeviations(manifest)) {
        ReportCoverage(estimate, truth, *stated, &result);
      }
    }
    return result;
  });
}

// A view's errors and looks, or their means.
struct ViewFigures {
  std::string name, photo;
  ViewError error;
  Looks looks;
};

Json JsonOf(const ViewFigures& view) {
  Json json = {{"mse", view.error.mse},
               {"rmse", view.error.rmse},
               {"log_l1", view.error.log_l1},
               {"texels", view.error.texels}};
  json.update(ToJson(view.looks));
  return json;
}

ViewFigures MeanOf(const std::vector<ViewFigures>& views) {
  ViewFigures mean{"mean", "", {}, {}};
  std::vector<Looks> looks;
  for (const ViewFigures& view : views) {
    mean.error.mse += view.error.mse / static_cast<double>(views.size());
    mean.error.rmse += view.error.rmse / static_cast<double>(views.size());
    mean.error.log_l1 += view.error.log_l1 / static_cast<double>(views.size());
    mean.error.texels += view.error.texels;
    looks.push_back(view.looks);
  }
  mean.looks = MeanLooks(looks);
  return mean;
}

std::string ErrorsText(const std::vector<ViewFigures>& lines) {
  std::string text =
      fmt::format("{:<12} {:<28} {:>10} {:>10} {:>10}\n", "view", "photo", "MSE", "RMSE", "log L1");
  for (const ViewFigures& view : lines) {
    text += fmt::format("{:<12} {:<28} {:>10.6f} {:>10.5f} {:>10.5f}\n", view.name, view.photo,
                        view.error.mse, view.error.rmse, view.error.log_l1);
  }
  return text;
}

// A figure with bands has its own name above those of the bands.
std::string ShortHeading(const LooksColumn& column) {
  const LooksFigure& figure = *column.figure;
  return figure.bands.empty() ? figure.heading : figure.bands[column.band].heading;
}

std::string LooksHeads(const std::vector<LooksColumn>& columns) {
  std::string names(12, ' '), bands = fmt::format("{:<12}", "view");
  size_t named = names.size();
  for (const LooksColumn& column : columns) {
    const std::string heading = ShortHeading(column);
    const int width = LooksWidth(heading);
    if (!column.figure->bands.empty() && column.band == 0) {
      names.resize(named, ' ');
      names += fmt::format("  {}", column.figure->heading);
    }
    bands += fmt::format(" {:>{}}", heading, width);
    named += static_cast<size_t>(width) + 1;
  }
  return "\n" + names + "\n" + bands + "\n";
}

std::string LooksTableText(const std::vector<ViewFigures>& lines) {
  const std::vector<LooksColumn> columns = LooksColumns();
  std::string text = LooksHeads(columns);
  for (const ViewFigures& view : lines) {
    text += fmt::format("{:<12}", view.name);
    for (const LooksColumn& column : columns) {
      text += fmt::format(" {:>{}}", LooksText(column.ValueOf(view.looks), 3),
                          LooksWidth(ShortHeading(column)));
    }
    text += "\n";
  }
  return text;
}

int RunViews(int argc, char** argv, const ProgramInfo& info) {
  fs::path fit_path, set_path, pairs;
  std::vector<std::string> only, exclude;
  OptionSet options;
  options.AddPositional("fit", &fit_path,
                        "manifest.json of fit or refine, its folder, or svbrdf.exr", true);
  options.AddPositional("views-of", &set_path, "manifest.json of rectify", true);
  options.Add("views", &only, "only these views, by view name or photograph name");
  options.Add("exclude", &exclude, "views to leave out, by view name or photograph name");
  options.Add("pairs", &pairs, "folder for pictures: photograph, rendering, 4 × difference");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    const fs::path file = fs::is_directory(set_path) ? set_path / "manifest.json" : set_path;
    const RectifiedSet set = ReadRectifiedSet(file);
    const FittedMaps fit = ReadFittedMaps(fit_path);
    const auto views = SelectViews(set, only, exclude);
    if (!pairs.empty()) fs::create_directories(pairs);
    std::vector<ViewFigures> lines;
    ProgramResult result;
    result.json["views"] = Json::array();
    for (const RectifiedView& view : views) {
      const RectifiedImage photograph = PhotographOfFit(fit, set, view);
      const std::vector<float> rendered = RenderFit(fit, set, view, common.threads);
      lines.push_back({view.name, view.photo, CompareView(rendered, photograph, view.ldr),
                       CompareLooks(rendered, photograph, view.ldr)});
      Json json = {{"name", view.name}, {"photo", view.photo}};
      json.update(JsonOf(lines.back()));
      result.json["views"].push_back(json);
      if (!pairs.empty()) WritePair(pairs / (view.name + ".png"), photograph, view.ldr, rendered);
    }
    lines.push_back(MeanOf(lines));
    result.text = ErrorsText(lines) + LooksTableText(lines);
    result.json["mean"] = JsonOf(lines.back());
    return result;
  });
}

ProgramResult ReportCameras(const CalibrationErrors& errors) {
  ProgramResult result;
  result.json = {{"focal_length_percent", errors.focal_length_percent},
                 {"principal_point_px", errors.principal_point_px},
                 {"largest_position_percent", errors.largest_position_percent},
                 {"mean_position_percent", errors.mean_position_percent},
                 {"corner_rms_texel", errors.corner_rms_texel},
                 {"largest_corner_rms_texel", errors.largest_corner_rms_texel},
                 {"light_power_percent", errors.light_power_percent},
                 {"missing_photos", errors.missing_photos},
                 {"photos", Json::array()}};
  result.text = fmt::format("{:<28} {:>12} {:>12} {:>10} {:>14}\n", "photo", "position %",
                            "rotation °", "light mm", "corners texel");
  for (const PhotoPoseError& photo : errors.photos) {
    result.json["photos"].push_back({{"photo", photo.photo},
                                     {"position_percent", photo.position_percent},
                                     {"rotation_deg", photo.rotation_deg},
                                     {"light_mm", photo.light_mm},
                                     {"corner_rms_texel", photo.corner_rms_texel}});
    result.text += fmt::format("{:<28} {:>12.4f} {:>12.4f} {:>10.3f} {:>14.4f}\n", photo.photo,
                               photo.position_percent, photo.rotation_deg, photo.light_mm,
                               photo.corner_rms_texel);
  }
  result.text += fmt::format(
      "focal length {:.4f} %, principal point {:.2f} px, camera position {:.4f} % (largest {:.4f} "
      "%)\n"
      "rectified corners {:.4f} texel RMS at 1024 (worst photo {:.4f}), light power {:.2f} %\n",
      errors.focal_length_percent, errors.principal_point_px, errors.mean_position_percent,
      errors.largest_position_percent, errors.corner_rms_texel, errors.largest_corner_rms_texel,
      errors.light_power_percent);
  if (errors.missing_photos > 0) {
    result.text += fmt::format("{} photographs of the ground truth were not calibrated\n",
                               errors.missing_photos);
  }
  return result;
}

fs::path ManifestIn(const fs::path& path) {
  return fs::is_directory(path) ? path / "manifest.json" : path;
}

// What a calibration is held against: a synthetic capture's truth, or another calibration.
struct Reference {
  Calibration calibration;
  Eigen::Vector2d sample_size_mm;
};

Reference ReadReference(const fs::path& path) {
  const fs::path facts_file = path / "truth.json";
  if (fs::exists(facts_file)) {
    const Json facts = Json::parse(ReadTextFile(facts_file), nullptr, false);
    const auto size = RequireNumbers(facts_file, facts, "truth", "sample_size_mm", 2);
    return {ReadCalibration(path / "calib" / "manifest.json"), {size[0], size[1]}};
  }
  const fs::path file = ManifestIn(path);
  if (!fs::exists(file)) {
    throw UserError(path, "", "neither truth.json nor a calibration's manifest.json",
                    "give a synthetic capture's truth/ or CAPTURE/glint/calib");
  }
  Calibration calibration = ReadCalibration(file);
  // CAPTURE/glint/calib/manifest.json
  const Capture capture = ReadCapture(fs::absolute(file).parent_path().parent_path().parent_path());
  return {std::move(calibration), {capture.sample_size_mm[0], capture.sample_size_mm[1]}};
}

int RunCameras(int argc, char** argv, const ProgramInfo& info) {
  fs::path truth, estimate;
  std::string align = "none";
  OptionSet options;
  options.AddPositional("truth", &truth,
                        "truth/ folder of a synthetic capture, or manifest.json of calib", true);
  options.AddPositional("estimate", &estimate, "manifest.json of calib", true);
  options.AddChoice("align", &align, {"none", "similarity"},
                    "similarity: first align the estimated cameras to the true ones by their "
                    "centres (rotation, translation, scale)");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions&) {
    const Reference reference = ReadReference(truth);
    Calibration calibration = ReadCalibration(ManifestIn(estimate));
    Similarity3 moved;
    if (align == "similarity") {
      calibration = AlignCalibration(reference.calibration, calibration, &moved);
    }
    ProgramResult result = ReportCameras(
        CompareCalibrations(reference.calibration, calibration, reference.sample_size_mm));
    if (align == "none") return result;
    const double angle_deg = Eigen::AngleAxisd(moved.rotation).angle() * 180 / std::numbers::pi;
    result.json["alignment"] = {
        {"scale", moved.scale},
        {"rotation_deg", angle_deg},
        {"translation_mm", {moved.translation.x(), moved.translation.y(), moved.translation.z()}}};
    result.text += fmt::format(
        "aligned by a similarity: scale {:.5f}, turned by {:.3f}°, moved by {:.3f} mm\n",
        moved.scale, angle_deg, moved.translation.norm());
    return result;
  });
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Verb> verbs = {
      {"maps",
       "Compares maps with ground truth: the six error measures of Gao et al. 2019, table 1.",
       "Example: glint-eval maps demo/glint/refine/svbrdf.exr demo/truth/svbrdf.exr", RunMaps},
      {"views", "Renders views from a fit and compares them with the photographs.",
       "Example: glint-eval views cards/glint/refine cards/glint/rectify --views photo_07.jpg",
       RunViews},
      {"cameras",
       "Compares a calibration with the ground truth of a synthetic capture, or with another "
       "calibration.",
       "Examples:\n  glint-eval cameras demo/truth demo/glint/calib/manifest.json\n"
       "  glint-eval cameras board/glint/calib colmap/glint/calib --align similarity",
       RunCameras}};
  verbs.push_back(HoldoutVerb());
  verbs.push_back(LightVerb());
  verbs.push_back(LimitsVerb());
  verbs.push_back(RelightVerb());
  verbs.push_back(TilingVerb());
  for (const Verb& verb : ExperimentVerbs()) verbs.push_back(verb);
  return RunVerb(
      argc, argv,
      {"glint-eval",
       "Evaluates maps, renderings and cameras, and reproduces the paper's tables and figures.",
       GLINT_VERSION, ""},
      verbs);
}
