#include "calib/triage/triage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/statistics/median.h"

namespace glint {
namespace {

int Side(const PhotoMeasures& photo) {
  return std::max(photo.file.image.width, photo.file.image.height);
}

using Measure = double PhotoMeasures::*;

// Median of the sharper half, as a share of the longer side; 0: nothing is measured.
double UsualShare(const std::vector<PhotoMeasures>& photos, Measure measure) {
  std::vector<double> shares;
  for (const PhotoMeasures& photo : photos) {
    if (photo.*measure > 0) shares.push_back(photo.*measure / Side(photo));
  }
  if (shares.empty()) return 0;
  std::sort(shares.begin(), shares.end());
  shares.resize((shares.size() + 1) / 2);
  return Median(shares);
}

// By the fits at the corners where there are some, and by all edges: a shake leaves the edges along
// it sharp, and corners that are too blurred are not found.
void FindBlurred(const std::vector<PhotoMeasures>& photos, const PhotoMeasures& photo,
                 const TriageOptions& options, std::vector<Remark>* remarks) {
  for (const auto& [measure, where] :
       {std::pair{&PhotoMeasures::blur_px, "half of the edges at the board's corners"},
        std::pair{&PhotoMeasures::edge_px, "nine in ten of the strong edges"}}) {
    const double usual_share = UsualShare(photos, measure);
    const double limit_px =
        Side(photo) * std::max(options.blur_share, options.blur_ratio * usual_share);
    const double found_px = photo.*measure;
    if (found_px <= limit_px) continue;
    remarks->push_back(
        {photo.name, RemarkKind::kBlurred,
         fmt::format("blurred: {} are {:.1f} px wide or wider (sigma; limit {:.1f} px, the sharp "
                     "photographs have {:.1f}); hold still, tap to focus",
                     where, found_px, limit_px, usual_share * Side(photo)),
         found_px, limit_px, true});
    return;
  }
}

// Samples of 10, 12 or 14 bits that a camera or a program left unscaled in 16; 0: they are not.
int UnscaledBits(const PhotoMeasures& photo) {
  if (photo.file.bits != 16 || photo.file.format == "raw" || photo.brightest <= 0) return 0;
  const auto top = static_cast<int>(std::lround(65535 * photo.brightest));
  for (const int bits : {8, 10, 12, 14}) {
    if (top < 1 << bits) return bits;
  }
  return 0;
}

void FindBadlyExposed(const PhotoMeasures& photo, const TriageOptions& options,
                      std::vector<Remark>* remarks) {
  const std::string where = photo.corners > 0 ? "the board's region" : "the picture";
  if (photo.clipped > options.clipped) {
    remarks->push_back(
        {photo.name, RemarkKind::kOverexposed,
         fmt::format("overexposed: {:.0f} % of {} has a saturated channel (limit {:.0f} %); expose "
                     "less",
                     100 * photo.clipped, where, 100 * options.clipped),
         photo.clipped, options.clipped, photo.clipped > 0.5});
  }
  // Linear pictures are brightened before they are looked at.
  const bool linear = photo.file.is_float() || photo.file.format == "raw";
  const int bits = UnscaledBits(photo);
  if (!linear && photo.white < options.white && bits > 0) {
    remarks->push_back(
        {photo.name, RemarkKind::kDark,
         fmt::format("dark: none of its 16-bit samples is above {:.0f} of 65535: they seem to have "
                     "{} bits and were not scaled; multiply them by {} when you export it",
                     65535 * photo.brightest, bits, 65536 >> bits),
         photo.white, options.white, true});
  } else if (!linear && photo.white < options.white) {
    remarks->push_back(
        {photo.name, RemarkKind::kDark,
         fmt::format(
             "dark: 99 % of {} is below {:.0f} of 255 (limit {:.0f}); expose more, or check "
             "that the flash fired",
             where, 255 * photo.white, 255 * options.white),
         photo.white, options.white, true});
  }
}

double Difference(const PhotoMeasures& a, const PhotoMeasures& b) {
  double sum = 0;
  for (size_t i = 0; i < a.thumbnail.size(); ++i) {
    const double d = static_cast<double>(a.thumbnail[i]) - b.thumbnail[i];
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.thumbnail.size()));
}

// The second and later of a kind.
void FindDuplicate(const std::vector<PhotoMeasures>& photos, size_t index,
                   const TriageOptions& options, std::vector<Remark>* remarks) {
  const PhotoMeasures& photo = photos[index];
  for (size_t i = 0; i < index; ++i) {
    const PhotoMeasures& other = photos[i];
    if (photo.thumbnail.empty() || other.thumbnail.size() != photo.thumbnail.size() ||
        photo.file.image.width != other.file.image.width ||
        photo.file.image.height != other.file.image.height) {
      continue;
    }
    const double difference = Difference(photo, other);
    if (difference > options.duplicate) continue;
    remarks->push_back(
        {photo.name, RemarkKind::kDuplicate,
         fmt::format("shows the same as {}: reduced in size, they differ by {:.2f} of 255 (limit "
                     "{:.1f}); it only gives this view more weight: leave one out",
                     other.name, difference, options.duplicate),
         difference, options.duplicate, true, other.name});
    return;
  }
}

}  // namespace

std::string_view RemarkName(RemarkKind kind) {
  switch (kind) {
    case RemarkKind::kBlurred:
      return "blurred";
    case RemarkKind::kDark:
      return "dark";
    case RemarkKind::kOverexposed:
      return "overexposed";
    case RemarkKind::kDuplicate:
      return "duplicate";
    case RemarkKind::kExif:
      return "exif";
  }
  return "";
}

std::vector<Remark> Triage(const std::vector<PhotoMeasures>& photos, const TriageOptions& options) {
  std::vector<Remark> remarks;
  for (size_t i = 0; i < photos.size(); ++i) {
    FindBlurred(photos, photos[i], options, &remarks);
    FindBadlyExposed(photos[i], options, &remarks);
    FindDuplicate(photos, i, options, &remarks);
  }
  const std::vector<Remark> exif = CheckExif(photos);
  remarks.insert(remarks.end(), exif.begin(), exif.end());
  return remarks;
}

Json ToJson(const PhotoMeasures& photo) {
  const Photo& f = photo.file;
  Json json = {{"size_px", {f.image.width, f.image.height}},
               {"format", f.format},
               {"bits", f.bits},
               {"colours", f.colour.Description()},
               {"orientation", f.orientation},
               {"camera", f.camera_model},
               {"focal_length_mm", f.exif.focal_length_mm},
               {"focal_length_35mm", f.focal_length_35mm},
               {"exposure_time_s", f.exposure_time_s},
               {"iso", f.iso},
               {"f_number", f.f_number},
               {"flash", f.exif.flash},
               {"exif_size_px", {f.exif.width_px, f.exif.height_px}}};
  if (f.exif.white_balance[1] > 0) json["white_balance"] = f.exif.white_balance;
  json["corners"] = photo.corners;
  json["blur_px"] = photo.blur_px;
  json["edge_px"] = photo.edge_px;
  json["clipped"] = photo.clipped;
  json["white"] = photo.white;
  return json;
}

Json ToJson(const std::vector<PhotoMeasures>& photos, const std::vector<Remark>& remarks) {
  Json json = {{"photos", Json::object()}, {"remarks", Json::array()}};
  for (const PhotoMeasures& photo : photos) json["photos"][photo.name] = ToJson(photo);
  for (const Remark& remark : remarks) {
    json["remarks"].push_back({{"photo", remark.photo},
                               {"kind", std::string(RemarkName(remark.kind))},
                               {"measure", remark.measure},
                               {"limit", remark.limit},
                               {"text", remark.text}});
  }
  return json;
}

}  // namespace glint
