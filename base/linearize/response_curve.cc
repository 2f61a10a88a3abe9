#include "base/linearize/response_curve.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/json_file.h"

namespace glint {
namespace {

constexpr size_t kMostBytes = 4u << 20;
constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr char kRemedy[] = "write it again with glint-response";

std::vector<float> ReadChannel(const std::filesystem::path& file, const Json& curve,
                               const std::string& name) {
  const std::string field = "curve." + name;
  if (!curve.is_object() || !curve.contains(name) || !curve[name].is_array() ||
      curve[name].size() != kResponseCodes) {
    throw UserError(file, field, "no list of 256 numbers", kRemedy);
  }
  std::vector<float> values;
  for (const Json& number : curve[name]) {
    const double value = number.is_number() ? number.get<double>() : -1;
    const bool rises = values.empty() ? value == 0 : value > values.back();
    if (!(value >= 0 && std::isfinite(value) && rises)) {
      throw UserError(file, field + "[" + std::to_string(values.size()) + "]", number.dump(),
                      "the curve must rise from 0; " + std::string(kRemedy));
    }
    values.push_back(static_cast<float>(value));
  }
  // That of an HDR picture goes beyond white.
  if (values.back() < 1) throw UserError(file, field, "a curve that ends below 1", kRemedy);
  return values;
}

}  // namespace

float ResponseCurve::Linear(int channel, float stored) const {
  const std::vector<float>& curve = linear[static_cast<size_t>(channel)];
  const float at = std::max(stored, 0.0f) * (kResponseCodes - 1);
  const int i = std::min(static_cast<int>(std::min(at, 1e6f)), kResponseCodes - 2);
  return curve[i] + (at - static_cast<float>(i)) * (curve[i + 1] - curve[i]);
}

float ResponseCurve::Stored(int channel, float linear_value) const {
  const std::vector<float>& curve = linear[static_cast<size_t>(channel)];
  const float value = std::max(linear_value, 0.0f);
  const auto above = std::upper_bound(curve.begin() + 1, curve.end() - 1, value);
  const auto i = above - curve.begin() - 1;
  return (static_cast<float>(i) + (value - curve[i]) / (curve[i + 1] - curve[i])) /
         (kResponseCodes - 1);
}

void WriteResponseCurve(const std::filesystem::path& file, const ResponseCurve& curve,
                        const Json& facts) {
  Json json = {{"format", "glint-response"}, {"version", 1}};
  json.update(facts);
  for (int c = 0; c < 3; ++c) json["curve"][kChannels[c]] = curve.linear[c];
  WriteFileAtomically(file, json.dump(1) + "\n");
}

ResponseCurve ReadResponseCurve(const std::filesystem::path& file) {
  const Json json = ReadJsonFile(file, kRemedy, kMostBytes);
  if (!json.is_object() || json.value("format", Json()) != "glint-response") {
    throw UserError(file, "", "no response curve (format: glint-response)", kRemedy);
  }
  if (json.value("version", Json()) != 1) {
    throw UserError(file, "version", json.value("version", Json()).dump(), kRemedy);
  }
  ResponseCurve curve;
  for (int c = 0; c < 3; ++c) {
    curve.linear[c] = ReadChannel(file, json.value("curve", Json()), kChannels[c]);
  }
  return curve;
}

}  // namespace glint
