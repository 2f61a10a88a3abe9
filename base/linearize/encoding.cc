#include "base/linearize/encoding.h"

#include <algorithm>
#include <cmath>

#include "base/colour/srgb.h"
#include "base/errors/errors.h"

#include "base/images/image_format.h"

namespace glint {
namespace {

// By nature.
bool IsLinear(const std::filesystem::path& file, int bits) {
  return bits > 16 || IsRawFileName(file);
}

}  // namespace

std::optional<Encoding> EncodingFromName(std::string_view name) {
  if (name == "linear" || name == "none") return Encoding::kLinear;
  if (name == "srgb") return Encoding::kSrgb;
  if (name == "gamma2.2") return Encoding::kGamma22;
  return std::nullopt;
}

std::string_view EncodingName(const Encoding& encoding) {
  switch (encoding.kind()) {
    case Encoding::kLinear:
      return "linear";
    case Encoding::kSrgb:
      return "srgb";
    case Encoding::kGamma22:
      return "gamma2.2";
    case Encoding::kResponse:
      return "response";
  }
  return "";
}

float LinearFromEncoded(const Encoding& encoding, float value, int channel) {
  const double v = std::max(value, 0.0f);
  switch (encoding.kind()) {
    case Encoding::kLinear:
      return static_cast<float>(v);
    case Encoding::kSrgb:
      return static_cast<float>(LinearFromSrgb(v));
    case Encoding::kGamma22:
      return static_cast<float>(std::pow(v, 2.2));
    case Encoding::kResponse:
      return encoding.curve().Linear(channel, value);
  }
  return 0;
}

float EncodedFromLinear(const Encoding& encoding, float value, int channel) {
  const double v = std::max(value, 0.0f);
  switch (encoding.kind()) {
    case Encoding::kLinear:
      return static_cast<float>(v);
    case Encoding::kSrgb:
      return static_cast<float>(SrgbFromLinear(v));
    case Encoding::kGamma22:
      return static_cast<float>(std::pow(v, 1 / 2.2));
    case Encoding::kResponse:
      return encoding.curve().Stored(channel, value);
  }
  return 0;
}

std::vector<float> LinearTable(const Encoding& encoding, int codes, int channel) {
  std::vector<float> table(codes);
  for (int i = 0; i < codes; ++i) {
    table[i] =
        LinearFromEncoded(encoding, static_cast<float>(i) / static_cast<float>(codes - 1), channel);
  }
  return table;
}

bool IsResponseFileName(const std::string& name) {
  return std::filesystem::path(name).extension() == ".json";
}

Encoding ResolveEncoding(const std::string& name, const std::filesystem::path& file,
                         const Photo& photo) {
  if (name == "auto" && photo.colour.has_curve() && !IsLinear(file, photo.bits)) {
    return Encoding(ResponseCurve{photo.colour.curve});
  }
  return ResolveEncoding(name, file, photo.bits);
}

Encoding ResolveEncoding(const std::string& name, const std::filesystem::path& file, int bits) {
  const bool linear = IsLinear(file, bits);
  if (name == "auto") return linear ? Encoding::kLinear : Encoding::kGamma22;
  if (IsResponseFileName(name)) {
    return linear ? Encoding(Encoding::kLinear) : Encoding(ReadResponseCurve(name));
  }
  const std::optional<Encoding> encoding = EncodingFromName(name);
  if (!encoding) {
    throw UserError("encoding: found '" + name +
                    "'; use auto, srgb, gamma2.2, linear or the name of a response curve's file "
                    "(.json)");
  }
  return *encoding;
}

}  // namespace glint
