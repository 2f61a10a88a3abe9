#include "fitting/reflectance/convention.h"

#include <sstream>
#include <stdexcept>

namespace glint {
namespace {

[[noreturn]] void Reject(std::string_view found) {
  throw std::invalid_argument(
      "reflectance convention: found '" + std::string(found) +
      "'; use photograph, dir2019, materialgan, or words of diffuse=one|one_minus_specular, "
      "light=none|inverse_square, sampling=pixel_centres|corner_to_corner");
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
