// A camera's tone curve as it was measured, and its file.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "base/files/json.h"

namespace glint {

inline constexpr int kResponseCodes = 256;

// Linear radiance of the stored values 0, 1/255 … 1, per channel R, G, B; rising, from 0 to 1, and
// beyond in HDR pictures.
// Between them values are interpolated linearly, so that 16-bit photographs have them too.
struct ResponseCurve {
  std::array<std::vector<float>, 3> linear;

  float Linear(int channel, float stored) const;  // stored below 0 is 0, above 1 goes on straight
  float Stored(int channel, float linear_value) const;  // the inverse
};

// The file: {"format": "glint-response", "version": 1, "curve": {"R": [256 numbers], "G", "B"}} and
// what else `facts` holds. Write throws EnvironmentError; Read throws UserError.
void WriteResponseCurve(const std::filesystem::path& file, const ResponseCurve& curve,
                        const Json& facts = Json::object());
ResponseCurve ReadResponseCurve(const std::filesystem::path& file);

}  // namespace glint
