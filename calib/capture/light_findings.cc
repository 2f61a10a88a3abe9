#include "calib/capture/light_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/statistics/median.h"
#include "base/text/name_list.h"

namespace glint {
namespace {

// In per cent, with its direction: "36 % darker".
std::string Against(double factor) {
  return fmt::format("{:.0f} % {}", 100 * std::abs(factor - 1), factor < 1 ? "darker" : "brighter");
}

void AddTurned(const CalibSummary& summary, std::vector<std::string>* words) {
  std::vector<std::string> names;
  for (size_t i = 0; i < summary.photos.size(); ++i) {
    if (summary.groups.pixel_turns[i] != 0) names.push_back(summary.photos[i].name);
  }
  if (names.empty()) return;
  words->push_back(fmt::format(
      "{}: the pixels were turned after the photograph was taken, and EXIF's orientation does not "
      "record it (a gallery app or an export does that); lens and flash are assumed to be turned "
      "with them. Use the camera's own files to be certain",
      NameList(names)));
}

constexpr double kWorthAWord = 0.182;  // ln 1.2: of exposures against EXIF

void AddExposures(const LightEstimate& light, std::vector<std::string>* words) {
  for (const LightOfPhoto& photo : light.photos) {
    if (!photo.contradicts) continue;
    const double factor = photo.exif_exposure > 0 ? photo.exposure.value / photo.exif_exposure : 1;
    if (std::abs(std::log(factor)) < kWorthAWord) {
      words->push_back(fmt::format(
          "{}: its paper is not lit as in the other photographs, and is not used to locate the "
          "flash: look for shadows, another lamp, or editing (light_residuals.png)",
          photo.name));
      continue;
    }
    words->push_back(fmt::format(
        "{}: its paper is {} than EXIF's exposure and the other photographs predict; its own "
        "brightness is used. Did the flash fire at another power, was a lamp on, or was the "
        "photograph "
        "edited?",
        photo.name, Against(factor)));
  }
  double largest = 1;
  for (const LightOfPhoto& photo : light.photos) {
    if (!photo.used || photo.exif_exposure <= 0) continue;
    const double factor = photo.exposure.value / photo.exif_exposure;
    if (std::abs(std::log(factor)) > std::abs(std::log(largest))) largest = factor;
  }
  if (std::abs(std::log(largest)) < kWorthAWord) return;
  words->push_back(fmt::format(
      "the paper contradicts EXIF's exposures by up to {:.0f} %; exposures estimated from the "
      "paper are used. Possible causes are a flash with automatic power, room light in some of the "
      "photographs, or an app that brightens photographs: set the flash to a fixed power, or use a "
      "lamp that is always on, in the dark",
      100 * std::abs(largest - 1)));
}

// Of its paper that has not clipped, what the flash explains.
double LitShare(const LightOfPhoto& photo) {
  const int judged = photo.inliers + photo.unlit;
  return judged > 0 ? static_cast<double>(photo.inliers) / judged : 1;
}

double UsualLitShare(const LightEstimate& light) {
  std::vector<double> shares;
  for (const LightOfPhoto& photo : light.photos) {
    if (photo.used) shares.push_back(LitShare(photo));
  }
  return shares.empty() ? 1 : Median(shares);
}

bool IsLitLess(const LightEstimate& light, const LightOfPhoto& photo, double share) {
  return LitShare(photo) < share * UsualLitShare(light);
}

void AddPartlyLit(const LightEstimate& light, std::vector<std::string>* words) {
  constexpr double kPartly = 0.8;  // good photographs keep 0.99, one with a shadow on a third 0.6
  std::vector<std::string> names;
  double least = 1;
  for (const LightOfPhoto& photo : light.photos) {
    if (!photo.used || !IsLitLess(light, photo, kPartly)) continue;
    names.push_back(photo.name);
    least = std::min(least, LitShare(photo));
  }
  if (names.empty()) return;
  words->push_back(fmt::format(
      "{}: parts of the white paper (down to {:.0f} % is left) are not lit as in the other "
      "photographs and are not used to locate the flash; the sample may be lit so, too: look for a "
      "shadow, another lamp, or editing (light_residuals.png), and leave such photographs out",
      NameList(names), 100 * least));
}

void AddWhiteBalance(const LightEstimate& light, std::vector<std::string>* words) {
  constexpr double kDrift = 0.02;
  std::vector<std::string> names;
  double largest = 0;
  for (const LightOfPhoto& photo : light.photos) {
    if (!photo.used) continue;
    const double off = std::max(std::abs(std::log(photo.colour[0] / photo.colour[1])),
                                std::abs(std::log(photo.colour[2] / photo.colour[1])));
    if (off < kDrift) continue;
    names.push_back(photo.name);
    largest = std::max(largest, off);
  }
  if (names.empty()) return;
  words->push_back(fmt::format(
      "{}: the white paper has another colour than in the first photograph (up to {:.0f} % between "
      "channels), which is corrected: the white balance changed. Lock it in the camera's settings",
      NameList(names), 100 * largest));
}

void AddTone(const Capture& capture, const LightEstimate& light, std::vector<std::string>* words) {
  if (!light.tone) return;
  const bool automatic = capture.encoding == "auto";
  const std::string read =
      automatic && light.srgb ? "auto\", here sRGB's" : capture.encoding + "\"";
  words->push_back(fmt::format(
      "the paper's brightness contradicts the tone curve that the photographs are read with "
      "([radiometry] encoding = \"{}): radiance is stored with an exponent of {:.2f} at the "
      "brightest paper and {:.2f} at the darkest. {} The curve below the darkest paper cannot be "
      "determined: switch HDR and scene modes off, photograph RAW, or measure the curve with glint "
      "response",
      read, light.tone->ExponentAt(light.tone->highest), light.tone->ExponentAt(light.tone->lowest),
      automatic ? "The curve estimated from the paper is used."
                : "The light is estimated with the curve from the paper; with encoding = "
                  "\"auto\" the photographs are read with it, too."));
}

void AddFlash(const Capture& capture, const LightEstimate& light, std::vector<std::string>* words) {
  // Phones' flashes lie within 5 mm of the lens's plane.
  constexpr double kBeside_mm = 30, kAlong_mm = 5, kSurely = 2;  // standard deviations
  const Eigen::Vector3d stated(capture.light_offset_mm.data());
  Eigen::Vector3d flash;
  for (int i = 0; i < 3; ++i) flash[i] = light.flash_in_camera_mm[i].value;
  if (light.flash_in_camera_mm[0].sigma <= 0) return;  // held
  const Eigen::Vector3d off = flash - stated;
  if (off.head<2>().norm() > kBeside_mm) {
    words->push_back(fmt::format(
        "according to the paper, the flash is {:.0f} mm beside {}: plausible for a camera's own "
        "flash, but a phone's is within 15 mm of its lens. If it is a phone, another lamp was on, "
        "or photographs were turned or cropped. If the flash is really there, state it in [light] "
        "offset_mm",
        off.head<2>().norm(), stated.isZero() ? "the lens" : "the position in [light] offset_mm"));
  }
  if (std::abs(off.z()) > kAlong_mm + kSurely * light.flash_in_camera_mm[2].sigma) {
    words->push_back(fmt::format(
        "according to the paper, the flash is {:.0f} mm {} {}, which is implausible for a phone: "
        "measure it, and state [light] offset_mm if this is correct; otherwise exposures, zoom or "
        "tone curve differ from those in EXIF and [radiometry], or another lamp was on, and the "
        "light's power is wrong",
        std::abs(off.z()), off.z() > 0 ? "before" : "behind",
        stated.isZero() ? "the lens" : "the position in [light] offset_mm"));
  }
}

// More than shadows' edges and a curled sheet leave.
constexpr double kUneven_percent = 5;

void AddUneven(const LightEstimate& light, std::vector<std::string>* words) {
  // Where the flash is held, the paper has told of no flash at all.
  if (light.rms_percent <= kUneven_percent || light.flash_in_camera_mm[0].sigma <= 0) return;
  words->push_back(fmt::format(
      "the paper's brightness deviates locally by {:.1f} % from what the flash explains "
      "(light_residuals.png), so the light's power may be off by tens of per cent: a phone's HDR "
      "brightens parts of a picture separately, and shadows or another lamp have a similar effect. "
      "Switch HDR, night and scene modes off, or photograph RAW, in the dark",
      light.rms_percent));
}

// The paper is taken for neutral. Phones' flashes and white balances leave it so to a tenth.
void AddTint(const LightEstimate& light, std::vector<std::string>* words) {
  constexpr double kTinted = 1.2;
  const auto [least, most] =
      std::minmax_element(light.power_rgb.begin(), light.power_rgb.end(),
                          [](const Estimate& a, const Estimate& b) { return a.value < b.value; });
  if (light.paper_rgb[0].sigma > 0 || !(most->value > kTinted * least->value)) return;
  words->push_back(fmt::format(
      "the white paper is not white in the photographs (red, green and blue as {:.2f} : 1 : "
      "{:.2f}): "
      "a cast of the white balance is corrected, but if the paper itself is tinted, the maps' "
      "colours are wrong by as much, and too bright if it is grey: print the board on white paper",
      light.power_rgb[0].value / light.power_rgb[1].value,
      light.power_rgb[2].value / light.power_rgb[1].value));
}

}  // namespace

std::string ContradictionOf(const LightEstimate& light, const LightOfPhoto& photo, bool flash_off) {
  constexpr double kNoFlash = 0.15;   // of the exposure: a zoom of 2.6 would be as dark
  constexpr double kHardlyLit = 0.4;  // without flash 0.12 of the paper fitted by chance
  if (!photo.contradicts) {
    if (!photo.used || !IsLitLess(light, photo, kHardlyLit)) return "";
    return fmt::format(
        "only {:.0f} % of its white paper is lit as a flash at the lens would light it (in the "
        "other "
        "photographs {:.0f} %): the flash did not fire, or a shadow or another lamp lies on it",
        100 * LitShare(photo), 100 * UsualLitShare(light));
  }
  const double factor = photo.exif_exposure > 0 ? photo.exposure.value / photo.exif_exposure : 1;
  if (factor < kNoFlash || (flash_off && factor < 1)) {
    return fmt::format(
        "its paper is {} than EXIF's exposure and the other photographs predict: the flash did not "
        "fire{}",
        Against(factor), flash_off ? ", as EXIF reports" : "");
  }
  if (photo.zoom == 1) return "";
  return fmt::format(
      "its paper is {} than EXIF's exposure and the other photographs predict, and its brightness "
      "falls off as if from {:.1f} times the distance that its corners give: it was taken with a "
      "zoom of about {:.1f} that EXIF does not report, or cropped and enlarged; photograph without "
      "zoom",
      Against(factor), photo.zoom, photo.zoom);
}

std::vector<std::string> LightFindings(const Capture& capture, const CalibSummary& summary) {
  std::vector<std::string> words;
  if (!summary.groups.pixel_turns.empty()) AddTurned(summary, &words);
  if (!summary.light.known) return words;
  AddExposures(summary.light, &words);
  AddPartlyLit(summary.light, &words);
  AddWhiteBalance(summary.light, &words);
  AddTone(capture, summary.light, &words);
  AddFlash(capture, summary.light, &words);
  AddUneven(summary.light, &words);
  AddTint(summary.light, &words);
  return words;
}

}  // namespace glint
