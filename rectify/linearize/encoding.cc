#include "rectify/linearize/encoding.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "pipeline/contract/errors.h"

namespace glint {

std::optional<Encoding> EncodingFromName(std::string_view name) {
  if (name == "linear" || name == "none") return Encoding::kLinear;
  if (name == "srgb") return Encoding::kSrgb;
  if (name == "gamma2.2") return Encoding::kGamma22;
  return std::nullopt;
}

std::string_view EncodingName(Encoding encoding) {
  switch (encoding) {
    case Encoding::kLinear:
      return "linear";
    case Encoding::kSrgb:
      return "srgb";
    case Encoding::kGamma22:
      return "gamma2.2";
  }
  return "";
}

float LinearFromEncoded(Encoding encoding, float value) {
  const double v = std::max(value, 0.0f);
  switch (encoding) {
    case Encoding::kLinear:
      return static_cast<float>(v);
    case Encoding::kSrgb:
      return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    case Encoding::kGamma22:
      return static_cast<float>(std::pow(v, 2.2));
  }
  return 0;
}

float EncodedFromLinear(Encoding encoding, float value) {
  const double v = std::max(value, 0.0f);
  switch (encoding) {
    case Encoding::kLinear:
      return static_cast<float>(v);
    case Encoding::kSrgb:
      return static_cast<float>(v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
    case Encoding::kGamma22:
      return static_cast<float>(std::pow(v, 1 / 2.2));
  }
  return 0;
}

std::vector<float> LinearTable(Encoding encoding, int codes) {
  std::vector<float> table(codes);
  for (int i = 0; i < codes; ++i) {
    table[i] = LinearFromEncoded(encoding, static_cast<float>(i) / static_cast<float>(codes - 1));
  }
  return table;
}

bool IsRawFileName(const std::filesystem::path& file) {
  static constexpr std::array kEndings = {".3fr", ".arw", ".cr2", ".cr3", ".crw", ".dng",
                                          ".erf", ".iiq", ".kdc", ".mrw", ".nef", ".nrw",
                                          ".orf", ".pef", ".raf", ".raw", ".rw2", ".srw"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

Encoding ResolveEncoding(const std::string& name, const std::filesystem::path& file, int bits) {
  if (name == "auto") {
    return bits > 16 || IsRawFileName(file) ? Encoding::kLinear : Encoding::kGamma22;
  }
  const std::optional<Encoding> encoding = EncodingFromName(name);
  if (!encoding) {
    throw UserError("encoding: found '" + name + "'; use auto, srgb, gamma2.2 or linear");
  }
  return *encoding;
}

}  // namespace glint
