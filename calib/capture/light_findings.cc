#include "calib/capture/light_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
      "tell so (a gallery app or an export does that); lens and flash are taken to be turned with "
      "them. The camera's own files leave no doubt",
      NameList(names)));
}

constexpr double kWorthAWord = 0.182;  // ln 1.2: of exposures against EXIF

void AddExposures(const LightEstimate& light, std::vector<std::string>* words) {
  for (const LightOfPhoto& photo : light.photos) {
    if (!photo.contradicts) continue;
    const double factor = photo.exif_exposure > 0 ? photo.exposure.value / photo.exif_exposure : 1;
    if (std::abs(std::log(factor)) < kWorthAWord) {
      words->push_back(fmt::format(
          "{}: its paper is not lit as in the other photographs, and tells nothing of the flash: "
          "look for shadows, another lamp, or a picture that was edited (light_residuals.png)",
          photo.name));
      continue;
    }
    words->push_back(fmt::format(
        "{}: its paper is {} than EXIF's exposure and the other photographs say; its own "
        "brightness is used. Did the flash fire at another power, or was the photograph edited?",
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
      "the paper contradicts EXIF's exposures by up to {:.0f} %; those of the paper are used. A "
      "flash that sets its own power, or photographs that an app has brightened, do that: fix the "
      "flash's power, or use a lamp that is always on",
      100 * std::abs(largest - 1)));
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
      "channels), which is taken out: the white balance changed. Fix it in the camera's settings",
      NameList(names), 100 * largest));
}

void AddTone(const Capture& capture, const LightEstimate& light, std::vector<std::string>* words) {
  if (!light.tone) return;
  const bool automatic = capture.encoding == "auto";
  words->push_back(fmt::format(
      "the paper's brightness contradicts the tone curve that the photographs are read with "
      "([radiometry] encoding = \"{}\"): radiance is stored with an exponent of {:.2f} at the "
      "brightest paper and {:.2f} at the darkest. {} What is darker than the paper is not told: "
      "switch HDR and scene modes off, photograph RAW, or measure the curve with glint response",
      capture.encoding, light.tone->ExponentAt(light.tone->highest),
      light.tone->ExponentAt(light.tone->lowest),
      automatic ? "The curve that the paper tells is used."
                : "The light is found with the curve that the paper tells; with encoding = "
                  "\"auto\" the photographs are read by it, too."));
}

void AddFlash(const Capture& capture, const LightEstimate& light, std::vector<std::string>* words) {
  constexpr double kBeside_mm = 30, kAlong_mm = 15;
  const Eigen::Vector3d stated(capture.light_offset_mm.data());
  Eigen::Vector3d flash;
  for (int i = 0; i < 3; ++i) flash[i] = light.flash_in_camera_mm[i].value;
  if (light.flash_in_camera_mm[0].sigma <= 0) return;  // held
  const Eigen::Vector3d off = flash - stated;
  if (off.head<2>().norm() > kBeside_mm) {
    words->push_back(fmt::format(
        "the paper puts the flash {:.0f} mm beside {}: right for a camera's own flash; a phone's "
        "is within 15 mm of its lens. If it is a phone, another lamp was on, or photographs were "
        "turned or cropped. A flash that is there belongs into [light] offset_mm",
        off.head<2>().norm(), stated.isZero() ? "the lens" : "where [light] offset_mm puts it"));
  }
  if (std::abs(off.z()) > kAlong_mm) {
    words->push_back(fmt::format(
        "the paper puts the flash {:.0f} mm {} {}, which a phone's is not: measure it and state "
        "[light] offset_mm if it is so; else exposures, zoom or tone curve are not what EXIF and "
        "[radiometry] say, and the light's power is wrong",
        std::abs(off.z()), off.z() > 0 ? "before" : "behind",
        stated.isZero() ? "the lens" : "where [light] offset_mm puts it"));
  }
}

// More than shadows' edges and a curled sheet leave.
constexpr double kUneven_percent = 5;

void AddUneven(const LightEstimate& light, std::vector<std::string>* words) {
  // Where the flash is held, the paper has told of no flash at all.
  if (light.rms_percent <= kUneven_percent || light.flash_in_camera_mm[0].sigma <= 0) return;
  words->push_back(fmt::format(
      "the paper is {:.1f} % brighter and darker from place to place than the flash explains "
      "(light_residuals.png), so that the light's power may be off by tens of per cent: a phone's "
      "HDR brightens parts of a picture by themselves, and shadows or another lamp do the like. "
      "Switch HDR, night and scene modes off, or photograph RAW, in the dark",
      light.rms_percent));
}

}  // namespace

std::string ContradictionOf(const LightOfPhoto& photo) {
  if (!photo.contradicts || photo.zoom == 1) return "";
  return fmt::format(
      "its paper is {} than EXIF's exposure and the other photographs say, and falls off as from "
      "{:.1f} times as far as its corners say: it was taken with a zoom of about {:.1f} that "
      "EXIF does not tell, or cropped and enlarged; photograph without zoom",
      Against(photo.exposure.value / photo.exif_exposure), photo.zoom, photo.zoom);
}

std::vector<std::string> LightFindings(const Capture& capture, const CalibSummary& summary) {
  std::vector<std::string> words;
  if (!summary.groups.pixel_turns.empty()) AddTurned(summary, &words);
  if (!summary.light.known) return words;
  AddExposures(summary.light, &words);
  AddWhiteBalance(summary.light, &words);
  AddTone(capture, summary.light, &words);
  AddFlash(capture, summary.light, &words);
  AddUneven(summary.light, &words);
  return words;
}

}  // namespace glint
