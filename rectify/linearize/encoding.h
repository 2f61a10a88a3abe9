// How a photograph's stored values encode radiance, and back.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/contract/image.h"

namespace glint {

enum class Encoding {
  kLinear,
  kSrgb,    // IEC 61966-2-1
  kGamma22  // radiance = value^2.2: what flash-capture data sets and phones' JPEGs are read as
};

// "linear" (also "none"), "srgb", "gamma2.2"; nullopt: none of these ("auto" included).
std::optional<Encoding> EncodingFromName(std::string_view name);
std::string_view EncodingName(Encoding encoding);

// Scalar curves on [0, ∞); negative values give 0. Above 1 they go on by the same formula.
float LinearFromEncoded(Encoding encoding, float value);
float EncodedFromLinear(Encoding encoding, float value);

// Linear value of code i of `codes` (256 or 65536): code codes − 1 is 1.
std::vector<float> LinearTable(Encoding encoding, int codes);

// The encoding of one photograph. `name` is "auto", or a name that EncodingFromName knows; "auto"
// is linear for floats and camera RAW files, gamma 2.2 for 8 and 16 bit. Throws UserError for
// others.
Encoding ResolveEncoding(const std::string& name, const std::filesystem::path& file, int bits);

// Whether the file name's ending is that of a camera's RAW format (DNG, CR2, NEF…).
bool IsRawFileName(const std::filesystem::path& file);

}  // namespace glint
