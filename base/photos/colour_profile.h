// What a photograph's numbers mean as colours: its ICC profile.
//
// Telephones write Display P3, cameras Adobe RGB, RAW developers ProPhoto: read as sRGB, a red is
// too dull by 7 to 9 ΔE. Profiles of three primaries and a curve each (ICC.1:2010, 8.4) are
// honoured; others, which are tables, are named.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct ColourProfile {
  std::string name;  // as the profile calls itself; empty: the photograph has none

  // Linear Rec.709 of the photograph's linear values, row-major; none: they are that already.
  // Colours beyond Rec.709 come out with negative channels.
  struct Matrix {
    std::array<float, 9> of{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::array<float, 3> operator()(const std::array<float, 3>& rgb) const {
      std::array<float, 3> result;
      for (std::size_t i = 0; i < 3; ++i) {
        result[i] = of[3 * i] * rgb[0] + of[3 * i + 1] * rgb[1] + of[3 * i + 2] * rgb[2];
      }
      return result;
    }
    friend bool operator==(const Matrix&, const Matrix&) = default;
  };
  Matrix rec709_from_rgb;
  bool converts() const { return rec709_from_rgb != Matrix(); }

  // Linear values of the stored ones 0, 1/255 … 1, of R, G, B, where 1 is white; those of HDR
  // pictures go beyond. Empty: sRGB's curve, or none is told.
  std::array<std::vector<float>, 3> curve;
  bool has_curve() const { return !curve[0].empty(); }

  // Why the profile is not used, and the numbers are taken for sRGB; empty: it is.
  std::string ignored;

  // "Display P3", "sRGB (assumed)", "Scanner X (not used: a table)".
  std::string Description() const;
};

// `icc`: the profile's bytes, however damaged.
ColourProfile ReadColourProfile(std::string_view icc);

// What HEIC and AVIF files name without a profile, by its numbers in ITU-T H.273. Primaries: 9
// (Rec.2020) and 12 (Display P3); others are taken for Rec.709's. Transfer: 8 (linear), 16 (PQ) and
// 18 (HLG), of which 1 is the reference white of Rec. ITU-R BT.2408; others are taken for sRGB's.
ColourProfile ProfileOfCodePoints(int primaries, int transfer);

// A PNG's gAMA: stored = linear^gamma. Close to 1/2.2: none, since that is what is assumed anyway.
ColourProfile ProfileOfGamma(double gamma);

// An EXR's chromaticities: CIE x and y of R, G, B and white. Rec.709's, or nonsense: none.
ColourProfile ProfileOfChromaticities(const std::array<float, 8>& xy);

// Adobe RGB (1998), which cameras name by EXIF's ColorSpace without a profile.
ColourProfile AdobeRgbProfile();

}  // namespace glint
