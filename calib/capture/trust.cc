#include "calib/capture/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/uncertainty/uncertainty_picture.h"
#include "calib/validation/diagnosis_picture.h"

namespace glint {
namespace {

bool Used(const BundleResult& result, size_t camera) { return result.cameras[camera].photos > 0; }

bool SolvedFor(const BundleResult& result, size_t camera) {
  const auto& sigma = result.cameras[camera].sigma;
  return Used(result, camera) &&
         std::any_of(sigma.begin(), sigma.end(), [](double s) { return s > 0; });
}

void AssessSample(const Capture& capture, const BundleResult& result, Trust* trust) {
  const Eigen::Vector2d size_mm(capture.sample_size_mm[0], capture.sample_size_mm[1]);
  if (capture.resolution_px[0] > 0) trust->texel_mm = size_mm.x() / capture.resolution_px[0];
  double variance = 0;
  int photos = 0;
  for (size_t i = 0; i < result.photos.size(); ++i) {
    trust->sample.push_back(result.photos[i].rejected.empty()
                                ? UncertaintyAtSample(result, i, size_mm)
                                : SampleUncertainty());
    if (!(trust->sample.back().sigma_mm > 0)) continue;
    variance += trust->sample.back().sigma_mm * trust->sample.back().sigma_mm;
    ++photos;
  }
  trust->sample_sigma_mm = std::sqrt(variance / std::max(1, photos));
}

std::vector<double> Lengths(const CameraDifference& difference) {
  std::vector<double> lengths;
  for (const Eigen::Vector2d& d : difference.difference_px) lengths.push_back(d.norm());
  return lengths;
}

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ValidationJson(const Trust& trust) {
  const CrossValidation& validation = trust.validation;
  if (!validation.problem.empty()) return {{"problem", validation.problem}};
  Json json = {{"held_out_rms_px", validation.held_out_rms_px},
               {"trusted", validation.trusted()},
               {"cameras", Json::array()}};
  for (const CameraDifference& camera : validation.cameras) {
    json["cameras"].push_back({{"camera", camera.camera},
                               {"difference_px", camera.rms_px},
                               {"predicted_px", camera.predicted_px},
                               {"ratio", camera.ratio()}});
  }
  return json;
}

Json ChoiceJson(const ModelChoice& choice) {
  Json json = {{"chosen", std::string(CameraModelName(choice.model))},
               {"reason", choice.reason},
               {"trials", Json::array()}};
  for (const ModelTrial& trial : choice.trials) {
    Json one = {{"model", std::string(CameraModelName(trial.model))}};
    if (trial.problem.empty()) {
      one.update({{"rms_px", trial.rms_px},
                  {"held_out_rms_px", trial.held_out_rms_px},
                  {"odd_even_ratio", trial.ratio}});
    } else {
      one["problem"] = trial.problem;
    }
    json["trials"].push_back(one);
  }
  return json;
}

Json DiagnosisJson(const BundleResult& result, const Diagnosis& diagnosis) {
  Json json = {{"findings", diagnosis.words}, {"place_rms_mm", diagnosis.place_rms_mm}};
  if (diagnosis.bend) {
    const BoardBend& bend = *diagnosis.bend;
    json["board_bend"] = {{"height_mm", {bend.height_mm.x(), bend.height_mm.y()}},
                          {"centre_mm", {bend.centre_mm.x(), bend.centre_mm.y()}},
                          {"half_size_mm", {bend.half_size_mm.x(), bend.half_size_mm.y()}},
                          {"sigma_mm",
                           {NumberOrNull(std::sqrt(bend.covariance(0, 0))),
                            NumberOrNull(std::sqrt(bend.covariance(1, 1)))}},
                          {"solved_for", result.bend.has_value()},
                          {"significant", diagnosis.board_is_bent}};
  }
  for (const char* list : {"moved_while_read", "blurred_by_motion"}) json[list] = Json::array();
  for (size_t i = 0; i < result.photos.size(); ++i) {
    const PhotoPattern& pattern = diagnosis.photos[i];
    if (pattern.moved_while_read) json["moved_while_read"].push_back(result.photos[i].name);
    if (pattern.scattered_on_a_line) json["blurred_by_motion"].push_back(result.photos[i].name);
  }
  return json;
}

std::string ChoiceText(const ModelChoice& choice) {
  std::string text = fmt::format("model: {}, {}\n", CameraModelName(choice.model), choice.reason);
  for (const ModelTrial& trial : choice.trials) {
    text += trial.problem.empty()
                ? fmt::format("  {:<14} {:.3f} px, held out {:.3f} px, odd/even ratio {:.2f}\n",
                              CameraModelName(trial.model), trial.rms_px, trial.held_out_rms_px,
                              trial.ratio)
                : fmt::format("  {:<14} {}\n", CameraModelName(trial.model), trial.problem);
  }
  return text;
}

std::string ValidationText(const CrossValidation& validation) {
  if (!validation.problem.empty()) {
    return "odd/even photographs: not compared: " + validation.problem + "\n";
  }
  std::string text;
  for (const CameraDifference& camera : validation.cameras) {
    text += fmt::format(
        "odd/even photographs, camera {}: projections differ by {:.3f} px RMS, predicted {:.3f} "
        "(ratio {:.2f})",
        camera.camera, camera.rms_px, camera.predicted_px, camera.ratio());
    text += camera.trusted() ? ": the uncertainties can be trusted\n"
                             : fmt::format(
                                   ": the model of lens, board or shutter, not noise, limits this "
                                   "calibration; multiply the uncertainties by {:.1f}, see "
                                   "odd_even_camera{}.png, try --model auto\n",
                                   camera.ratio(), camera.camera);
  }
  return text;
}

std::string SampleText(const BundleResult& result, const Trust& trust) {
  if (!(trust.sample_sigma_mm > 0)) return "";
  const size_t worst = trust.WorstPhoto();
  std::string text =
      fmt::format("at the sample: positions are known to ± {:.4f} mm", trust.sample_sigma_mm);
  if (trust.texel_mm > 0) {
    text += fmt::format(" ({:.2f} texel)", trust.sample_sigma_mm / trust.texel_mm);
  }
  return text + fmt::format("; least certain in {}: ± {:.4f} mm\n", result.photos[worst].name,
                            trust.sample[worst].sigma_mm);
}

}  // namespace

size_t Trust::WorstPhoto() const {
  return static_cast<size_t>(
      std::max_element(sample.begin(), sample.end(),
                       [](const SampleUncertainty& a, const SampleUncertainty& b) {
                         return a.sigma_mm < b.sigma_mm;
                       }) -
      sample.begin());
}

Trust AssessTrust(const Capture& capture, const BundleProblem& problem,
                  const BundleOptions& options, const BundleResult& result) {
  Trust trust;
  for (size_t c = 0; c < result.cameras.size(); ++c) {
    trust.projection.push_back(SolvedFor(result, c) ? MapUncertainty(result, static_cast<int>(c))
                                                    : UncertaintyMap());
  }
  AssessSample(capture, result, &trust);
  trust.validation = CrossValidate(problem, options, result);
  trust.diagnosis = Diagnose(problem, options, result);
  return trust;
}

std::string MisfitInWords(const CrossValidation& validation) {
  constexpr double kWorthAWord_px = 0.25;  // a quarter of a texel where texels are pixels
  for (const CameraDifference& camera : validation.cameras) {
    if (camera.rms_px < kWorthAWord_px || camera.trusted()) continue;
    return fmt::format(
        "calibrations from every other photograph differ by {:.2f} px where noise predicts {:.3f}: "
        "focal length, distances and height may be wrong by more than is stated. Optical "
        "stabilisation, a focus that changes, or a moving camera does that: lock focus, switch "
        "stabilisation off where that is possible, hold still",
        camera.rms_px, camera.predicted_px);
  }
  return "";
}

void WriteTrustPictures(const BundleResult& result, const Trust& trust, Stage* stage) {
  for (size_t c = 0; c < result.cameras.size(); ++c) {
    const int camera = static_cast<int>(c);
    if (!Used(result, c)) continue;
    if (!trust.projection[c].grid.points_px.empty()) {
      WritePng(stage->Output(fmt::format("projection_camera{}.png", c)),
               UncertaintyPicture(result, camera, trust.projection[c]));
    }
    WritePng(stage->Output(fmt::format("residuals_by_photo_camera{}.png", c)),
             PhotosPicture(result, trust.diagnosis, camera));
  }
  for (const CameraDifference& camera : trust.validation.cameras) {
    const std::string text = fmt::format(
        "camera {}: odd against even photographs, px: {:.3f} RMS where corners were seen, "
        "predicted {:.3f}, ratio {:.2f}",
        camera.camera, camera.rms_px, camera.predicted_px, camera.ratio());
    WritePng(stage->Output(fmt::format("odd_even_camera{}.png", camera.camera)),
             MapPicture(result.cameras[camera.camera].camera, camera.grid, Lengths(camera),
                        SeenCorners(result, camera.camera), text));
  }
  WritePng(stage->Output("residuals_by_place.png"), PlacesPicture(trust.diagnosis));
}

void AddTrustMetrics(const BundleResult& result, const Trust& trust, Json* metrics) {
  Json& json = *metrics;
  json["projection_uncertainty"] = Json::array();
  for (size_t c = 0; c < trust.projection.size(); ++c) {
    const UncertaintyMap& map = trust.projection[c];
    if (map.grid.points_px.empty()) continue;
    json["projection_uncertainty"].push_back({{"camera", c},
                                              {"depth_mm", map.depth_mm},
                                              {"centre_px", NumberOrNull(map.centre_px)},
                                              {"median_px", map.median_px},
                                              {"largest_px", map.largest_px}});
  }
  if (trust.sample_sigma_mm > 0) {
    Json sample = {{"sigma_mm", trust.sample_sigma_mm},
                   {"worst_photo", result.photos[trust.WorstPhoto()].name}};
    if (trust.texel_mm > 0) sample["sigma_texel"] = trust.sample_sigma_mm / trust.texel_mm;
    for (size_t i = 0; i < trust.sample.size(); ++i) {
      if (trust.sample[i].sigma_mm > 0) {
        sample["by_photo_mm"][result.photos[i].name] = trust.sample[i].sigma_mm;
      }
    }
    json["sample_uncertainty"] = sample;
  }
  json["cross_validation"] = ValidationJson(trust);
  json["diagnosis"] = DiagnosisJson(result, trust.diagnosis);
  if (trust.choice) json["model_choice"] = ChoiceJson(*trust.choice);
}

void AddTrustResiduals(const BundleResult& result, const Trust& trust, Json* residuals) {
  Json& json = *residuals;
  json["about_places"] =
      "per corner id [x_mm, y_mm, offset x, y, z in mm, their standard deviations, photos]: where "
      "the photographs together see it, less where it should be; z off the board's plane";
  json["places"] = Json::object();
  for (const PlaceMean& p : trust.diagnosis.places) {
    json["places"][std::to_string(p.id)] = {p.position_in_sample_mm.x(),
                                            p.position_in_sample_mm.y(),
                                            p.offset_mm.x(),
                                            p.offset_mm.y(),
                                            p.offset_mm.z(),
                                            p.sigma_mm.x(),
                                            p.sigma_mm.y(),
                                            p.sigma_mm.z(),
                                            p.photos};
  }
  for (size_t i = 0; i < result.photos.size(); ++i) {
    if (!result.photos[i].rejected.empty()) continue;
    const PhotoPattern& p = trust.diagnosis.photos[i];
    json["patterns"][result.photos[i].name] = {{"along_px", p.mean_length_px},
                                               {"across_px", p.across_px},
                                               {"axis_deg", p.axis_deg},
                                               {"row_motion_px", p.row_motion_px},
                                               {"row_motion_share", p.row_motion_share},
                                               {"row_motion_f", p.row_motion_f},
                                               {"column_motion_share", p.column_motion_share}};
  }
}

std::string TextOf(const BundleResult& result, const Trust& trust) {
  std::string text;
  if (trust.choice) text += ChoiceText(*trust.choice);
  for (size_t c = 0; c < trust.projection.size(); ++c) {
    const UncertaintyMap& map = trust.projection[c];
    if (map.grid.points_px.empty()) continue;
    text += fmt::format(
        "projection, camera {}: ± {:.3f} px in the centre, ± {:.3f} median, ± {:.3f} at worst over "
        "the picture (at {:.0f} mm)\n",
        c, map.centre_px, map.median_px, map.largest_px, map.depth_mm);
  }
  text += SampleText(result, trust) + ValidationText(trust.validation);
  for (const std::string& words : trust.diagnosis.words) text += "found: " + words + "\n";
  if (trust.diagnosis.words.empty()) {
    text += "found: residuals show no bent board, rolling shutter or motion\n";
  }
  return text;
}

}  // namespace glint
