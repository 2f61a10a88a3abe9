#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/capture/capture_light.h"

namespace glint {
namespace {

// JSON has no infinity: what cannot be told is null.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json JsonOf(const Estimate& estimate) {
  return {{"value", Number(estimate.value)}, {"sigma", Number(estimate.sigma)}};
}

Json JsonOf(const std::array<Estimate, 3>& estimates) {
  Json json = {{"value", Json::array()}, {"sigma", Json::array()}};
  for (const Estimate& estimate : estimates) {
    json["value"].push_back(Number(estimate.value));
    json["sigma"].push_back(Number(estimate.sigma));
  }
  return json;
}

Json BoardLight(const LightEstimate& light) {
  Json json;
  json["flash_in_camera_mm"] = JsonOf(light.flash_in_camera_mm);
  json["power_rgb"] = JsonOf(light.power_rgb);
  json["ambient_rgb"] = JsonOf(light.ambient_rgb);
  json["paper_rgb"] = JsonOf(light.paper_rgb);
  json["paper_gloss"] = JsonOf(light.gloss);
  json["ink_smear"] = JsonOf(light.smear);
  json["vignetting"] = Json::array();
  for (size_t c = 0; c < light.vignetting.size(); ++c) {
    Json v = JsonOf(light.vignetting[c]);
    v["largest_sigma"] = Number(light.vignetting_sigma[c]);
    const Eigen::Matrix3d& covariance = light.vignetting_covariance[c];
    v["covariance"] = std::vector<double>(covariance.data(), covariance.data() + 9);
    json["vignetting"].push_back(v);
  }
  json["srgb"] = light.srgb;
  json["residual_rms_percent"] = light.rms_percent;
  json["paper_samples"] = light.samples;
  json["inliers"] = light.inliers;
  json["held"] = light.held;
  json["photos"] = Json::array();
  for (const LightOfPhoto& photo : light.photos) {
    json["photos"].push_back({{"photo", photo.name},
                              {"used", photo.used},
                              {"exposure", JsonOf(photo.exposure)},
                              {"paper_samples", photo.samples},
                              {"inliers", photo.inliers},
                              {"residual_rms_percent", photo.rms_percent}});
  }
  return json;
}

std::string PlusMinus(const std::array<Estimate, 3>& e, const char* format) {
  const auto number = [format](double value) { return fmt::format(fmt::runtime(format), value); };
  return fmt::format("[{}, {}, {}] ± [{}, {}, {}]", number(e[0].value), number(e[1].value),
                     number(e[2].value), number(e[0].sigma), number(e[1].sigma),
                     number(e[2].sigma));
}

std::string BoardText(const LightEstimate& light) {
  std::string text = fmt::format(
      "light: {} of {} spots of white paper, residual {:.2f} %\n  flash in the camera frame {} "
      "mm\n  power {}\n  ambient irradiance {}\n",
      light.inliers, light.samples, light.rms_percent,
      PlusMinus(light.flash_in_camera_mm, "{:.2f}"), PlusMinus(light.power_rgb, "{:.4g}"),
      PlusMinus(light.ambient_rgb, "{:.3g}"));
  if (light.srgb) {
    text += "  sRGB's tone curve explains the paper better than gamma 2.2 and is used\n";
  }
  for (size_t c = 0; c < light.vignetting.size(); ++c) {
    double corner = 0;
    for (const Estimate& v : light.vignetting[c]) corner += v.value;
    text +=
        fmt::format("  camera {}: the corners lose {:.1f} % of the light, fall-off ± {:.2f} %\n", c,
                    -100 * corner, 100 * light.vignetting_sigma[c]);
  }
  text += fmt::format("  paper's gloss {:.4f} ± {:.4f}\n", light.gloss.value, light.gloss.sigma);
  for (const LightOfPhoto& photo : light.photos) {
    text += fmt::format("  {:<28} exposure {:.4f} ± {:.4f}  {:4} of {:4} spots  {:.2f} %{}\n",
                        photo.name, photo.exposure.value, photo.exposure.sigma, photo.inliers,
                        photo.samples, photo.rms_percent, photo.used ? "" : "  (not used)");
  }
  return text;
}

Json LampMetrics(const CalibSummary& summary) {
  Json json = {{"point_sd", summary.lamps.point_sd},
               {"colour_sd", summary.lamps.colour_sd},
               {"photos", Json::array()}};
  for (size_t i = 0; i < summary.lamps.lamps.size(); ++i) {
    const LampStrength& lamp = summary.lamps.lamps[i];
    json["photos"].push_back({{"photo", summary.calibration.photos[i].photo},
                              {"exposure", lamp.exposure},
                              {"colour", {lamp.colour.x(), lamp.colour.y(), lamp.colour.z()}},
                              {"used_share", lamp.used_share}});
  }
  return json;
}

std::string LampText(const CalibSummary& summary) {
  if (summary.lamps.lamps.empty()) return "light: exposures from EXIF, or all equal\n";
  double least = 1e300, most = 0;
  for (const LampStrength& lamp : summary.lamps.lamps) {
    least = std::min(least, lamp.exposure);
    most = std::max(most, lamp.exposure);
  }
  return fmt::format(
      "light: strengths from {:.2f} to {:.2f} of the mean, colours differ by {:.1f} %, estimated "
      "from the sample's matte parts\n",
      least, most, 100 * summary.lamps.colour_sd);
}

}  // namespace

Json LightMetrics(const CalibSummary& summary) {
  Json json;
  json["power"] = {summary.calibration.light_rgb.x(), summary.calibration.light_rgb.y(),
                   summary.calibration.light_rgb.z()};
  json["source"] = summary.power_source;
  json["advice"] = LightAdvice(summary);
  if (summary.light.known) {
    json["board"] = BoardLight(summary.light);
    return json;
  }
  if (!summary.lamps.lamps.empty()) {
    json["lamps"] = LampMetrics(summary);
    return json;
  }
  if (summary.calibration.fixed_camera) return json;
  if (!summary.light.problem.empty()) json["problem"] = summary.light.problem;
  const Eigen::Vector3d& by_paper = summary.power.light_rgb;
  json["by_board"] =
      summary.power.known ? Json({by_paper.x(), by_paper.y(), by_paper.z()}) : Json(nullptr);
  json["spread"] = summary.power.spread;
  json["paper_samples"] = summary.power.samples;
  for (size_t i = 0; i < summary.calibration.photos.size(); ++i) {
    json["by_photo"][summary.calibration.photos[i].photo] = summary.power.photo_power[i];
  }
  return json;
}

std::string LightText(const CalibSummary& summary) {
  std::string text;
  if (summary.calibration.fixed_camera) {
    text = LampText(summary);
  } else if (summary.light.known) {
    text = BoardText(summary.light);
  } else {
    const Eigen::Vector3d& power = summary.calibration.light_rgb;
    text = fmt::format("light: power [{:.4g}, {:.4g}, {:.4g}] (from {}", power.x(), power.y(),
                       power.z(), summary.power_source);
    if (summary.power.known) {
      text += fmt::format(", {} spots of paper, standard deviation over photos {:.1f} %",
                          summary.power.samples, 100 * summary.power.spread);
    }
    text += ")\n";
  }
  for (const std::string& advice : LightAdvice(summary)) text += "  note: " + advice + "\n";
  return text;
}

}  // namespace glint
