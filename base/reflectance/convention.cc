#include "base/reflectance/convention.h"

#include <array>
#include <charconv>
#include <sstream>
#include <stdexcept>

namespace glint {
namespace {

[[noreturn]] void Reject(std::string_view found) {
  throw std::invalid_argument(
      "reflectance convention: found '" + std::string(found) +
      "'; use photograph, dir2019, materialgan, or words of diffuse=one|one_minus_specular, "
      "light=none|inverse_square, sampling=pixel_centres|corner_to_corner, "
      "narrow_lobe=SHARExRATIO[@F0] (a share from 0 to below 1, a ratio of roughnesses up to 1, a "
      "coat's F0 up to 1), tail=EXPONENT (a whole number from 2, GGX, to 32), "
      "anisotropy=RATIO@DEGREES (a ratio from 1 to 100, a direction from 0 to below 180)");
}

constexpr std::string_view kNarrowLobe = "narrow_lobe=", kTail = "tail=",
                           kAnisotropy = "anisotropy=";

// The shortest digits that mean this number.
std::string Shortest(double x) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr};
}

// Takes `before` and the number after it off the beginning of `text`; false, and nothing is taken:
// they are not there.
bool TakeNumber(std::string_view before, std::string_view* text, double* number) {
  if (!text->starts_with(before)) return false;
  const char* const end = text->data() + text->size();
  const auto read = std::from_chars(text->data() + before.size(), end, *number);
  if (read.ec != std::errc()) return false;
  text->remove_prefix(static_cast<size_t>(read.ptr - text->data()));
  return true;
}

// "0.5x0.4", "0.5x0.4@0.04": into `lobes`, the rest of which stays.
void ParseNarrowLobe(std::string_view text, SpecularLobes* lobes) {
  std::string_view left = text;
  double share = 0, ratio = 1, coat_f0 = 0;
  const bool both = TakeNumber("", &left, &share) && TakeNumber("x", &left, &ratio);
  const bool coat = both && TakeNumber("@", &left, &coat_f0);
  const bool in_range =
      share >= 0 && share < 1 && ratio > 0 && ratio <= 1 && (!coat || coat_f0 > 0) && coat_f0 <= 1;
  if (!both || !left.empty() || !in_range) Reject(text);
  lobes->narrow_share = share;
  lobes->narrow_ratio = ratio;
  lobes->coat_f0 = coat_f0;
}

// "1.5@90"
Anisotropy ParseAnisotropy(std::string_view text) {
  std::string_view left = text;
  Anisotropy found;
  const bool both =
      TakeNumber("", &left, &found.ratio) && TakeNumber("@", &left, &found.direction_deg);
  const bool in_range = found.ratio >= 1 && found.ratio <= kMostAnisotropy &&
                        found.direction_deg >= 0 && found.direction_deg < 180;
  if (!both || !left.empty() || !in_range) Reject(text);
  return found;
}

int ParseTail(std::string_view text) {
  int tail = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, tail);
  const bool in_range = tail >= kLeastTail && tail <= kMostTail;
  if (read.ec != std::errc() || read.ptr != end || !in_range) Reject(text);
  return tail;
}

void SetWord(const std::string& word, ReflectanceConvention* convention) {
  if (word == "diffuse=one") {
    convention->diffuse_weight = DiffuseWeight::kOne;
  } else if (word == "diffuse=one_minus_specular") {
    convention->diffuse_weight = DiffuseWeight::kOneMinusSpecular;
  } else if (word == "light=none") {
    convention->falloff = LightFalloff::kNone;
  } else if (word == "light=inverse_square") {
    convention->falloff = LightFalloff::kInverseSquare;
  } else if (word == "sampling=pixel_centres") {
    convention->sampling = TexelSampling::kPixelCentres;
  } else if (word == "sampling=corner_to_corner") {
    convention->sampling = TexelSampling::kCornerToCorner;
  } else if (word.starts_with(kNarrowLobe)) {
    ParseNarrowLobe(std::string_view(word).substr(kNarrowLobe.size()), &convention->lobes);
  } else if (word.starts_with(kTail)) {
    convention->lobes.tail_exponent = ParseTail(std::string_view(word).substr(kTail.size()));
  } else if (word.starts_with(kAnisotropy)) {
    convention->lobes.anisotropy =
        ParseAnisotropy(std::string_view(word).substr(kAnisotropy.size()));
  } else {
    Reject(word);
  }
}

}  // namespace

std::string ToString(const ReflectanceConvention& convention) {
  std::string text = "diffuse=";
  text += convention.diffuse_weight == DiffuseWeight::kOne ? "one" : "one_minus_specular";
  text += " light=";
  text += convention.falloff == LightFalloff::kNone ? "none" : "inverse_square";
  text += " sampling=";
  text +=
      convention.sampling == TexelSampling::kPixelCentres ? "pixel_centres" : "corner_to_corner";
  const SpecularLobes& lobes = convention.lobes;
  if (lobes.two()) {
    text += " " + std::string(kNarrowLobe) + Shortest(lobes.narrow_share) + "x" +
            Shortest(lobes.narrow_ratio);
    if (lobes.coat_f0 > 0) text += "@" + Shortest(lobes.coat_f0);
  }
  if (lobes.tail_exponent != 2) {
    text += " " + std::string(kTail) + std::to_string(lobes.tail_exponent);
  }
  if (lobes.anisotropy.any()) {
    text += " " + std::string(kAnisotropy) + Shortest(lobes.anisotropy.ratio) + "@" +
            Shortest(lobes.anisotropy.direction_deg);
  }
  return text;
}

ReflectanceConvention ParseReflectanceConvention(std::string_view text) {
  if (text == "photograph") return ReflectanceConvention::Photograph();
  if (text == "dir2019") return ReflectanceConvention::Dir2019();
  if (text == "materialgan") return ReflectanceConvention::MaterialGan();
  ReflectanceConvention convention;
  std::istringstream words{std::string(text)};
  std::string word;
  bool any = false;
  while (words >> word) {
    SetWord(word, &convention);
    any = true;
  }
  if (!any) Reject(text);
  return convention;
}

}  // namespace glint
