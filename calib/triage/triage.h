// Photographs that are worth a word: blurred, badly exposed, taken twice, or with an EXIF that
// contradicts itself, the picture or the others.
#pragma once

#include <string>
#include <vector>

#include "base/files/json.h"
#include "calib/triage/measure.h"

namespace glint {

enum class RemarkKind { kBlurred, kDark, kOverexposed, kDuplicate, kExif };
std::string_view RemarkName(RemarkKind kind);  // "blurred", "dark", …

struct Remark {
  std::string photo;  // empty: it is about all
  RemarkKind kind = RemarkKind::kExif;
  std::string text;               // what was found, with the measure and its limit, and the remedy
  double measure = 0, limit = 0;  // 0, 0: a contradiction is not a number
  bool condemns = false;          // the photograph does more harm than good
  std::string same_as = {};       // of a duplicate: the photograph that it repeats
};

struct TriageOptions {
  // Edges: wider than this many times the median of the sharper half of the photographs, and wider
  // than this share of the picture's longer side. A good phone has 1 to 1.5 px of 4000.
  double blur_ratio = 2, blur_share = 6e-4;
  double clipped = 0.25;   // share of the board's region
  double white = 0.25;     // darker: the bright parts are in the lowest fourth of the codes
  double duplicate = 1.2;  // RMS difference of thumbnails, 8-bit levels
};

// Per-photo remarks in the photographs' order, then those about all.
std::vector<Remark> Triage(const std::vector<PhotoMeasures>& photos,
                           const TriageOptions& options = {});

// The part of it that reads EXIF alone. `flash` photographs in which no flash fired are named.
std::vector<Remark> CheckExif(const std::vector<PhotoMeasures>& photos);

// What was read from EXIF, and the measures.
Json ToJson(const PhotoMeasures& photo);

// {"photos": {name: measures and what was read from EXIF}, "remarks": […]}
Json ToJson(const std::vector<PhotoMeasures>& photos, const std::vector<Remark>& remarks);

}  // namespace glint
