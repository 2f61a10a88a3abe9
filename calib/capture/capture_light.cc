#include "calib/capture/capture_light.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "base/camera/orientation.h"
#include "base/files/files.h"
#include "calib/capture/light_findings.h"
#include "calib/light/light_picture.h"

namespace glint {
namespace {

size_t DetectedIndex(const CalibSummary& summary, const CalibratedPhoto& photo) {
  const auto found = std::find_if(summary.photos.begin(), summary.photos.end(),
                                  [&](const DetectedPhoto& p) { return p.name == photo.photo; });
  return static_cast<size_t>(found - summary.photos.begin());
}

// Exposures relative to the first calibrated photograph, by EXIF where all photographs have it,
// else all equal.
std::vector<double> ExifExposures(const CalibSummary& summary) {
  std::vector<double> exposures;
  for (const CalibratedPhoto& photo : summary.calibration.photos) {
    exposures.push_back(summary.photos[DetectedIndex(summary, photo)].exposure);
  }
  const bool known =
      std::all_of(exposures.begin(), exposures.end(), [](double e) { return e > 0; });
  const double first = exposures[0];
  for (double& exposure : exposures) exposure = known ? exposure / first : 1;
  return exposures;
}

// Without paper to go by: the power that makes a white surface below the camera reach 0.8.
double GuessedPower(const Calibration& calibration) {
  const CalibratedPhoto& photo = calibration.photos[0];
  const Eigen::Vector3d light = Inverse(photo.camera_from_sample) * photo.light_in_camera_mm;
  return 0.8 * 3.14159265358979 * light.squaredNorm();
}

Eigen::Vector3d Values(const std::array<Estimate, 3>& estimates) {
  return {estimates[0].value, estimates[1].value, estimates[2].value};
}

// COLMAP's poses, and a stated one, are what they are.
bool PosesFollowTheLight(const CalibSummary& summary) { return summary.from_board(); }

LightProblem ProblemOf(const CalibSummary& summary) {
  LightProblem problem;
  problem.bend = summary.bundle.bend;
  for (const CameraEstimate& camera : summary.bundle.cameras) {
    problem.cameras.push_back(camera.camera);
  }
  for (const size_t detected : summary.FlashPhotos()) {
    LightPhoto& added = problem.photos.emplace_back();
    added.name = summary.photos[detected].name;
    if (PosesFollowTheLight(summary)) {
      // A picture upside down has the same size; one on its side has not, or is known to be turned.
      added.possible_turns = {0, 2};
      added.surely_turned = summary.groups.surely_turned[detected];
    }
    added.camera = summary.groups.group[detected];
    added.camera_from_sample =
        summary.bundle.photos[summary.BundleIndex(detected)].camera_from_sample;
    added.exposure = summary.photos[detected].exposure;
    added.clips = summary.photos[detected].clips;
    added.samples = summary.photos[detected].paper;
  }
  return problem;
}

// RAW and floats are linear by nature, a response curve was measured, and photographs with several
// profiles have no curve in common.
bool MayHaveToneCurve(const Capture& capture, const CalibSummary& summary) {
  if (IsResponseFileName(capture.encoding) || capture.encoding == "linear") return false;
  const std::string* profile = nullptr;
  for (const DetectedPhoto& photo : summary.photos) {
    if (photo.board_photo) continue;
    const Photo& file = photo.measures.file;
    if (!photo.clips || file.format == "raw") return false;
    if (profile != nullptr && file.colour.name != *profile) return false;
    profile = &file.colour.name;
  }
  return true;
}

// Which may be sRGB's curve as well: nobody said it.
bool ReadWithGamma22(const Capture& capture, const CalibSummary& summary) {
  return capture.encoding == "auto" &&
         std::all_of(summary.photos.begin(), summary.photos.end(), [](const DetectedPhoto& photo) {
           return photo.board_photo ||
                  ResolveEncoding("auto", photo.name, photo.measures.file) == Encoding::kGamma22;
         });
}

LightOptions LightOptionsOf(const Capture& capture, const CalibOptions& options,
                            const CalibSummary& summary) {
  LightOptions light;
  light.paper_reflectance = options.paper_reflectance;
  light.offset_mm = Eigen::Vector3d(capture.light_offset_mm.data());
  light.power = Eigen::Vector3d(capture.light_power.data());
  const Eigen::Vector3d ambient(capture.ambient.data());
  if (ambient.maxCoeff() > 0) light.ambient = ambient;
  if (options.quick_px > 0) light.spots_per_photo = 120;  // for what it says of the photographs
  light.tone_known = !MayHaveToneCurve(capture, summary);
  light.perhaps_srgb = !light.tone_known && ReadWithGamma22(capture, summary);
  return light;
}

// Exposures of photographs whose paper said nothing: by EXIF, relative to one whose did.
void FillExposures(const CalibSummary& summary, Calibration* calibration) {
  const std::vector<double> exif = ExifExposures(summary);
  const std::vector<LightOfPhoto>& photos = summary.light.photos;
  const auto used = std::find_if(photos.begin(), photos.end(),
                                 [](const LightOfPhoto& photo) { return photo.used; });
  const size_t first = static_cast<size_t>(used - photos.begin());
  for (size_t i = 0; i < photos.size(); ++i) {
    calibration->photos[i].exposure =
        photos[i].used || photos[i].contradicts ? photos[i].exposure.value : exif[i] / exif[first];
    if (photos[i].used || photos[i].contradicts) continue;
    spdlog::warn("{}: too little unclipped white paper; its exposure is taken from EXIF",
                 photos[i].name);
  }
  // The first photograph's exposure is 1 in everything that follows.
  const double gauge = calibration->photos[0].exposure;
  for (CalibratedPhoto& photo : calibration->photos) photo.exposure /= gauge;
  calibration->light_rgb *= gauge;
  *calibration->ambient_rgb *= gauge;
}

// White balances that changed by more than they are known.
void FillWhiteBalance(const LightEstimate& light, Calibration* calibration) {
  constexpr double kWorthCorrecting = 0.01;
  for (size_t i = 0; i < light.photos.size(); ++i) {
    const Eigen::Vector3d& colour = light.photos[i].colour;
    if (colour.maxCoeff() / colour.minCoeff() < 1 + kWorthCorrecting) continue;
    calibration->photos[i].white_balance_rgb = colour;
  }
}

void TakeEstimate(const Capture& capture, CalibSummary* summary) {
  const LightEstimate& light = summary->light;
  Calibration& calibration = summary->calibration;
  calibration.light_rgb = Values(light.power_rgb);
  calibration.ambient_rgb = Values(light.ambient_rgb);
  calibration.light_power_known = true;
  const auto& flash = light.flash_in_camera_mm;
  const double sd_mm = std::max({flash[0].sigma, flash[1].sigma, flash[2].sigma});
  if (sd_mm > 0) calibration.light_sd_mm = sd_mm;  // 0: held
  for (CalibratedPhoto& photo : calibration.photos) {
    const size_t detected = DetectedIndex(*summary, photo);
    photo.light_in_camera_mm =
        TurnedCameraPoint(Values(light.flash_in_camera_mm), summary->groups.turns[detected]);
    const auto& v = light.vignetting[summary->groups.group[detected]];
    calibration.cameras[photo.camera].vignetting = {v[0].value, v[1].value, v[2].value};
  }
  FillExposures(*summary, &calibration);
  FillWhiteBalance(light, &calibration);
  if (ToneCurveOf(capture, *summary)) calibration.tone_curve = "tone_curve.json";
}

// By EXIF; of a lamp that is always on, all are.
bool ReportedOff(const DetectedPhoto& photo) {
  const int flash = photo.measures.file.exif.flash;
  return flash >= 0 && (flash & 1) == 0;
}

// The paper's assumption: the light at the lens, or where capture.toml puts it; all photographs'
// exposures as EXIF says; no fall-off.
void FillSimpleLight(const Capture& capture, const CalibOptions& options, CalibSummary* summary) {
  Calibration& calibration = summary->calibration;
  const std::vector<double> exposures = ExifExposures(*summary);
  std::vector<LitPaper> papers;
  for (size_t i = 0; i < calibration.photos.size(); ++i) {
    const CalibratedPhoto& photo = calibration.photos[i];
    papers.push_back({photo.camera_from_sample, photo.light_in_camera_mm, exposures[i],
                      summary->photos[DetectedIndex(*summary, photo)].paper});
  }
  PowerOptions power;
  power.paper_reflectance = options.paper_reflectance;
  power.ambient = Eigen::Vector3d(capture.ambient.data());
  calibration.ambient_rgb = power.ambient;
  summary->power = EstimatePower(papers, power);
  const Eigen::Vector3d given(capture.light_power.data());
  calibration.light_power_known = true;
  if (given.maxCoeff() > 0) {
    calibration.light_rgb = given;
    summary->power_source = "capture.toml";
  } else if (summary->power.known) {
    calibration.light_rgb = summary->power.light_rgb;
    summary->power_source = "board, light at the lens";
  } else {
    calibration.light_rgb.setConstant(GuessedPower(calibration));
    calibration.light_power_known = false;
    summary->power_source = "guess";
    spdlog::warn(
        "no large enough unclipped area of the board's paper is visible; the light's power is a "
        "guess, which later stages refine");
  }
}

}  // namespace

LightEstimate EstimateBoardLight(const Capture& capture, const CalibOptions& options,
                                 const CalibSummary& summary) {
  if (options.light != "board" || summary.FlashPhotos().empty()) return {};
  return EstimateLight(ProblemOf(summary), LightOptionsOf(capture, options, summary));
}

bool FollowLight(CalibSummary* summary) {
  const std::vector<size_t> flash = summary->FlashPhotos();
  const auto off = std::count_if(flash.begin(), flash.end(),
                                 [&](size_t i) { return ReportedOff(summary->photos[i]); });
  const bool others_fired = 2 * off < static_cast<std::ptrdiff_t>(flash.size());
  bool changed = false;
  for (size_t k = 0; k < summary->light.photos.size(); ++k) {
    const LightOfPhoto& photo = summary->light.photos[k];
    CameraGroups& groups = summary->groups;
    const size_t i = flash[k];
    if (photo.turns != 0) {
      groups.turns[i] = (groups.turns[i] + photo.turns) % 4;
      groups.pixel_turns[i] = (groups.pixel_turns[i] + photo.turns) % 4;
      changed = true;
    }
    const std::string reason =
        ContradictionOf(summary->light, photo, others_fired && ReportedOff(summary->photos[i]));
    if (reason.empty()) continue;
    LeaveOut(reason, &summary->photos[i]);
    summary->left_out_before.push_back({photo.name, reason});
    changed = true;
  }
  return changed;
}

void FillLight(const Capture& capture, const CalibOptions& options, CalibSummary* summary) {
  const bool estimated = summary->light.known || !summary->light.problem.empty();
  if (!estimated) summary->light = EstimateBoardLight(capture, options, *summary);
  summary->light_findings = LightFindings(capture, *summary);
  for (const std::string& word : summary->light_findings) spdlog::warn("{}", word);
  if (options.light == "board") {
    if (summary->light.known) {
      summary->power_source =
          Eigen::Vector3d(capture.light_power.data()).maxCoeff() > 0 ? "capture.toml" : "board";
      TakeEstimate(capture, summary);
      for (const std::string& word : summary->light.held) spdlog::warn("light: {}", word);
      return;
    }
    spdlog::warn("{}; the light is assumed to be at the lens, or where capture.toml puts it",
                 summary->light.problem);
  }
  FillSimpleLight(capture, options, summary);
}

void WriteLightPicture(const CalibSummary& summary, Stage* stage) {
  if (!summary.light.known) return;
  WritePng(stage->Output("light_residuals.png"), LightPicture(ProblemOf(summary), summary.light));
  Json json;
  json["about"] =
      "per photo and spot of white paper [x_px, y_px, seen / predicted - 1 of r, g, b, inlier], in "
      "the stored picture; the centre of the top-left pixel is (0.5, 0.5)";
  json["photos"] = Json::object();
  for (const LightOfPhoto& photo : summary.light.photos) {
    Json spots = Json::array();
    for (const LightOfPhoto::Spot& spot : photo.spots) {
      spots.push_back({spot.point_px.x(), spot.point_px.y(), spot.relative.x(), spot.relative.y(),
                       spot.relative.z(), spot.inlier});
    }
    json["photos"][photo.name] = spots;
  }
  WriteFileAtomically(stage->Output("light_residuals.json"), json.dump(1) + "\n");
}

std::optional<ResponseCurve> ToneCurveOf(const Capture& capture, const CalibSummary& summary) {
  const LightEstimate& light = summary.light;
  if (!(light.tone || light.srgb) || capture.encoding != "auto") return std::nullopt;
  const DetectedPhoto& first = summary.photos[summary.FlashPhotos()[0]];
  const Encoding encoding = ResolveEncoding("auto", first.name, first.measures.file);
  ResponseCurve curve;
  for (int c = 0; c < 3; ++c) {
    curve.linear[c] = LinearTable(encoding, kResponseCodes, c);
    const bool hdr = curve.linear[c].back() > 1;
    float before = -1;
    for (float& value : curve.linear[c]) {
      const double read = light.srgb ? SrgbForGamma22(value) : value;
      value = static_cast<float>(light.tone ? light.tone->Linear(read) : read);
      value = std::max(value, std::nextafter(before, 2.0f));  // profiles' tables begin with zeros
      if (before < 0) value = 0;
      before = value;
    }
    if (!hdr) curve.linear[c].back() = 1;
  }
  return curve;
}

std::vector<std::string> LightAdvice(const CalibSummary& summary) {
  const LightEstimate& light = summary.light;
  std::vector<std::string> advice = light.held;
  advice.insert(advice.end(), summary.light_findings.begin(), summary.light_findings.end());
  if (!light.known) return advice;
  constexpr double kFlash_mm = 2, kAmbientOfFlash = 0.01, kVignetting = 0.01, kResidual = 3,
                   kSaidBefore = 5;
  double flash = 0;
  for (const Estimate& estimate : light.flash_in_camera_mm) flash = std::max(flash, estimate.sigma);
  if (flash > kFlash_mm) {
    advice.push_back(
        fmt::format("the flash's position is uncertain by {:.1f} mm; take photographs tilted by 20 "
                    "to 40 degrees in several directions",
                    flash));
  }
  const auto& first = summary.calibration.photos[0];
  const double height = Inverse(first.camera_from_sample).translation.norm();
  for (int c = 0; c < 3; ++c) {
    const double share =
        light.ambient_rgb[c].sigma * height * height / std::max(1e-9, light.power_rgb[c].value);
    if (share <= kAmbientOfFlash) continue;
    advice.push_back(
        fmt::format("the ambient illumination is uncertain by {:.1f} % of the flash; take "
                    "photographs from more heights, or darken the room",
                    100 * share));
    break;
  }
  for (const double sigma : light.vignetting_sigma) {
    if (sigma <= kVignetting) continue;
    advice.push_back(
        fmt::format("the lens's fall-off is uncertain by {:.1f} %; take photographs with the board "
                    "near the picture's edge",
                    100 * sigma));
  }
  const bool said = light.rms_percent > kSaidBefore && light.flash_in_camera_mm[0].sigma > 0;
  if (light.rms_percent > kResidual && !said) {
    advice.push_back(fmt::format(
        "the paper's brightness differs from the estimated light by {:.1f} %: see "
        "light_residuals.png "
        "for shadows, a lamp, a curled sheet, or another tone curve ([radiometry] encoding)",
        light.rms_percent));
  }
  return advice;
}

}  // namespace glint
