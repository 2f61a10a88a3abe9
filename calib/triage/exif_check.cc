// What EXIF says against itself, the picture or the other photographs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/camera/orientation.h"
#include "base/text/name_list.h"
#include "calib/triage/triage.h"

namespace glint {
namespace {

constexpr double kStops = 0.5;          // two tags that tell the same thing may differ by this
constexpr double kWhiteBalance = 0.01;  // relative

void Say(const PhotoMeasures& photo, std::string text, std::vector<Remark>* remarks) {
  remarks->push_back({photo.name, RemarkKind::kExif, std::move(text)});
}

bool Differ(double a, double b, double stops) {
  return a > 0 && b > 0 && std::abs(std::log2(a / b)) > stops;
}

void CheckSize(const PhotoMeasures& photo, std::vector<Remark>* remarks) {
  const ExifFacts& exif = photo.file.exif;
  const int width = photo.file.image.width, height = photo.file.image.height;
  if (exif.width_px == 0 || exif.height_px == 0) return;
  const auto sorted = [](int a, int b) { return std::pair{std::min(a, b), std::max(a, b)}; };
  if (sorted(exif.width_px, exif.height_px) == sorted(width, height)) return;
  const auto [a, b] = sorted(exif.width_px, exif.height_px);
  const auto [c, d] = sorted(width, height);
  const bool scaled =
      std::abs(static_cast<double>(a) * d / (static_cast<double>(b) * c) - 1) < 0.01;
  Say(photo,
      fmt::format("EXIF reports {}x{} pixels, the picture has {}x{}: it was {} after it was taken; "
                  "use the camera's own file{}",
                  exif.width_px, exif.height_px, width, height, scaled ? "scaled" : "cropped",
                  scaled ? "" : ", or its focal length and centre are meaningless"),
      remarks);
}

void CheckLens(const PhotoMeasures& photo, std::vector<Remark>* remarks) {
  const ExifFacts& exif = photo.file.exif;
  if (exif.focal_is_zero) {
    Say(photo, "EXIF reports a focal length of 0 mm; only the board is used", remarks);
  }
  // A sensor as large as film and larger is no phone's; its crop factor would be 1 or less.
  if (exif.focal_length_mm > 0 && photo.file.focal_length_35mm > 0 &&
      photo.file.focal_length_35mm < 0.7 * exif.focal_length_mm) {
    Say(photo,
        fmt::format("EXIF reports a focal length of {:g} mm and {:g} mm as its 35 mm equivalent, "
                    "which contradict each other; only the board is used",
                    exif.focal_length_mm, photo.file.focal_length_35mm),
        remarks);
  }
  if (exif.digital_zoom > 1.01) {
    Say(photo,
        fmt::format(
            "EXIF reports a digital zoom of {:g}: the picture is enlarged; photograph without zoom",
            exif.digital_zoom),
        remarks);
  }
  if (!QuarterTurns(photo.file.orientation)) {
    Say(photo,
        fmt::format("orientation {} is that of a mirrored picture, which no camera stores: it is "
                    "treated as a camera of its own",
                    photo.file.orientation),
        remarks);
  }
}

void CheckExposure(const PhotoMeasures& photo, std::vector<Remark>* remarks) {
  const Photo& file = photo.file;
  if (Differ(file.exposure_time_s, file.exif.shutter_s, kStops)) {
    Say(photo,
        fmt::format(
            "EXIF reports an exposure time of {:.5g} s and a shutter speed of {:.5g} s; the "
            "first is used",
            file.exposure_time_s, file.exif.shutter_s),
        remarks);
  }
  if (Differ(file.f_number, file.exif.aperture_f, 0.5 * kStops)) {
    Say(photo,
        fmt::format(
            "EXIF reports an f-number of {:.3g} and an aperture of f/{:.3g}; the first is used",
            file.f_number, file.exif.aperture_f),
        remarks);
  }
  if (file.exif.iso_is_zero) Say(photo, "EXIF reports an ISO of 0, which is invalid", remarks);
}

void SayAll(std::string text, std::vector<Remark>* remarks) {
  remarks->push_back({"", RemarkKind::kExif, std::move(text)});
}

// One sentence for all that lack the same.
void CheckColours(const std::vector<PhotoMeasures>& photos, std::vector<Remark>* remarks) {
  constexpr int kUncalibrated = 65535;
  std::vector<std::string> unknown, grey;
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> ignored;
  for (const PhotoMeasures& photo : photos) {
    const ColourProfile& colour = photo.file.colour;
    if (photo.flash_photo && photo.file.grey) grey.push_back(photo.name);
    if (!colour.ignored.empty()) {
      ignored[{colour.name, colour.ignored}].push_back(photo.name);
    } else if (colour.name.empty() && photo.file.exif.colour_space == kUncalibrated &&
               photo.file.format != "raw") {
      unknown.push_back(photo.name);
    }
  }
  if (!grey.empty()) {
    SayAll(
        fmt::format("{}: stored as greyscale: the maps will have no colour. Copy the camera's own "
                    "files, or switch its monochrome mode off",
                    NameList(grey, 4)),
        remarks);
  }
  for (const auto& [profile, names] : ignored) {
    SayAll(fmt::format("{}: the colour profile '{}' is not used ({}), colours are read as sRGB; "
                       "convert the photographs to sRGB, or to 16-bit TIFF in linear Rec.709",
                       NameList(names, 4), profile.first, profile.second),
           remarks);
  }
  if (unknown.empty()) return;
  SayAll(fmt::format("{}: EXIF says that the colours are not sRGB, and no profile says what they "
                     "are: read as sRGB; set the camera to sRGB, or keep the profile in the file",
                     NameList(unknown, 4)),
         remarks);
}

void CheckModels(const std::vector<PhotoMeasures>& photos, std::vector<Remark>* remarks) {
  std::map<std::string, std::vector<std::string>> by_model;
  for (const PhotoMeasures& photo : photos) {
    const std::string& model = photo.file.camera_model;
    by_model[model.empty() ? "an unknown camera" : model].push_back(photo.name);
  }
  if (by_model.size() < 2) return;
  std::string text = "photographs of several cameras in one capture: ";
  bool first = true;
  for (const auto& [model, names] : by_model) {
    text += (first ? "" : "; ") + model + " (" + NameList(names, 4) + ")";
    first = false;
  }
  SayAll(text + ". Each gets intrinsics of its own; their colours and exposures are not comparable",
         remarks);
}

void CheckFlash(const std::vector<PhotoMeasures>& photos, std::vector<Remark>* remarks) {
  std::vector<const PhotoMeasures*> without;
  size_t told = 0;
  for (const PhotoMeasures& photo : photos) {
    if (!photo.flash_photo || photo.file.exif.flash < 0) continue;
    ++told;
    if ((photo.file.exif.flash & 1) == 0) without.push_back(&photo);
  }
  if (told > 1 && without.size() == told) {
    SayAll(fmt::format("EXIF reports that the flash fired in none of {} photographs; switch it on, "
                       "or light them with the phone's lamp",
                       told),
           remarks);
    return;
  }
  for (const PhotoMeasures* photo : without) {
    Say(*photo, "EXIF reports that the flash did not fire; leave it out, or switch the flash on",
        remarks);
  }
}

// Exposures count only where all flash photographs tell theirs.
void CheckCompleteness(const std::vector<PhotoMeasures>& photos, std::vector<Remark>* remarks) {
  std::vector<std::string> missing;
  size_t flash = 0;
  for (const PhotoMeasures& photo : photos) {
    if (!photo.flash_photo) continue;
    ++flash;
    const Photo& f = photo.file;
    if (f.exposure() > 0) continue;
    std::string lacks;
    for (const auto& [what, there] :
         {std::pair{"exposure time", f.exposure_time_s > 0}, std::pair{"ISO", f.iso > 0},
          std::pair{"f-number", f.f_number > 0}}) {
      if (!there) lacks += (lacks.empty() ? "" : ", ") + std::string(what);
    }
    missing.push_back(photo.name + " (no " + lacks + ")");
  }
  if (missing.empty()) return;
  if (missing.size() == flash) {
    SayAll(
        "no photograph's EXIF reports exposure time, ISO and f-number; all exposures are assumed "
        "equal: keep exposure locked, or keep EXIF when copying",
        remarks);
  } else {
    SayAll(fmt::format("{} of {} photographs have no exposure in their EXIF: {}. All exposures are "
                       "assumed equal; use the camera's own files",
                       missing.size(), flash, NameList(missing, 4)),
           remarks);
  }
}

void CheckWhiteBalance(const std::vector<PhotoMeasures>& photos, std::vector<Remark>* remarks) {
  const PhotoMeasures* first = nullptr;
  for (const PhotoMeasures& photo : photos) {
    const auto& balance = photo.file.exif.white_balance;
    if (balance[1] == 0) continue;
    if (first == nullptr) first = &photo;
    const auto& reference = first->file.exif.white_balance;
    const double off =
        std::max(std::abs(balance[0] / reference[0] - 1), std::abs(balance[2] / reference[2] - 1));
    if (off <= kWhiteBalance) continue;
    Say(photo,
        fmt::format("the camera's white balance (red {:.3f}, blue {:.3f}) is not that of {} "
                    "({:.3f}, {:.3f}); lock the white balance in the camera",
                    balance[0], balance[2], first->name, reference[0], reference[2]),
        remarks);
  }
}

void CheckFormats(const std::vector<PhotoMeasures>& photos, std::vector<Remark>* remarks) {
  std::vector<std::string> linear;
  size_t others = 0;
  for (const PhotoMeasures& photo : photos) {
    if (!photo.flash_photo) continue;
    if (photo.file.format == "raw" || photo.file.is_float()) {
      linear.push_back(photo.name);
    } else {
      ++others;
    }
  }
  if (linear.empty() || others == 0) return;
  SayAll("RAW or float photographs (" + NameList(linear, 4) +
             ") together with developed ones: their brightness is not comparable; use one kind",
         remarks);
}

}  // namespace

std::vector<Remark> CheckExif(const std::vector<PhotoMeasures>& photos) {
  std::vector<Remark> remarks;
  for (const PhotoMeasures& photo : photos) {
    CheckSize(photo, &remarks);
    CheckLens(photo, &remarks);
    CheckExposure(photo, &remarks);
  }
  CheckColours(photos, &remarks);
  CheckFlash(photos, &remarks);
  CheckWhiteBalance(photos, &remarks);
  CheckModels(photos, &remarks);
  CheckFormats(photos, &remarks);
  CheckCompleteness(photos, &remarks);
  return remarks;
}

}  // namespace glint
