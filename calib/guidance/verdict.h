// What a person should know of a capture while the sample still lies on the table.
//
// Facts are geometry; every sentence of advice follows from one of the limits below, and tells the
// photograph to take.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "calib/guidance/coverage.h"
#include "calib/guidance/suggestion.h"

namespace glint {

struct LeftOutPhoto {
  std::string name, reason;
};

struct GuidanceInput {
  std::array<double, 2> sample_size_mm{0, 0};
  std::array<int, 2> resolution_px{0, 0};  // of the maps
  std::vector<GuidancePhoto> photos;       // those that are used
  std::vector<LeftOutPhoto> left_out;
  // Standard deviation of the focal length relative to itself, the worst camera's; 0: it was given.
  double focal_sigma = 0;
  // The photographs did not determine the focal length, and one was assumed.
  bool focal_assumed = false;
  // The camera stood still and the light was moved: the advice is light_advice.h's.
  bool fixed_camera = false;
  // How far the sample as described reaches over the printed board, on which sides; empty: not.
  std::string over_board;
  // What can be wrong with the board's place; a sentence each.
  std::vector<std::string> board_findings;
  // What the paper's light says against EXIF, encoding or the flash's place; a sentence each.
  std::vector<std::string> light_findings;
};

struct GuidanceLimits {
  double highlight_deg = 8;     // half vector to normal, see coverage.h: half the peak of r = 0.46
  double dark_share = 0.05;     // of the sample without highlight that is worth a word
  double unseen_share = 0.005;  // of the sample in no photograph
  double top_deg = 10;          // a photograph nearer to the normal is a top view
  double tilted_deg = 15;       // one farther from it is tilted
  double gap_deg = 150;         // between the sides tilted photographs are taken from
  int few_photos = 5, enough_photos = 12;
  double texel_px = 0.8;  // a texel smaller than this, in pixels of the sharpest photograph
  // Blur of a photograph that is sharp to the pixel: of a lens of 0.5 and the pixel's own area.
  double sharp_px = 0.58;
  double cut_share = 0.1;      // of the sample beside a photograph
  double clipped_share = 0.2;  // Gao et al. 2019, fig. 14: 20 % are harmless
  double left_out_share = 0.25;
  double focal_sigma = 0.01;
  // Of a fixed camera.
  int few_lights = 8, enough_lights = 24;
  double light_gap_deg = 90;  // between the sides from which it was lit
  double high_deg = 60;       // the elevation of some lights, which show gloss
  double low_deg = 35;        // and of others, which show relief
};

enum class Importance { kNeeded, kUseful, kHint };

struct Advice {
  std::string topic;  // "top", "highlight" …: see advice.h
  Importance importance = Importance::kHint;
  std::string text;  // one sentence
};

struct ViewFacts {
  std::string photo;
  Direction camera, light;
  double distance_mm = 0;
  double least_half_angle_deg = 0;  // over the sample
  double shown_share = 0, clipped_share = 0;
  double texel_px = 0;  // pixels per texel; 0: unknown
  double blur_px = 0;   // standard deviation of the edges' blur; 0: unknown
};

struct Verdict {
  std::vector<ViewFacts> views;
  Coverage coverage;
  double highlight_share = 0, shown_share = 0;
  double sharpest_texel_px = 0;  // 0: unknown
  AzimuthGap gap;                // between tilted photographs
  int top_views = 0, tilted_views = 0;
  bool fixed_camera = false;  // the light was moved; then
  AzimuthGap light_gap;       // between lights that do not stand above the sample, and
  double lowest_light_deg = 90, highest_light_deg = 0;  // elevation
  std::vector<Suggestion> suggestions;  // photographs that bring highlights where there are none
  double highlight_share_then = 0;      // with these
  std::vector<Advice> advice;           // most important first
  GuidanceLimits limits;

  // "good", "usable" or "not enough".
  std::string Word() const;
  std::string Summary() const;  // one line of figures
};

// `input.photos` must not be empty.
Verdict Judge(const GuidanceInput& input, const GuidanceLimits& limits = {});

// Word, figures, and at most six lines of advice.
std::string TextOf(const Verdict& verdict);
Json ToJson(const Verdict& verdict);

}  // namespace glint
