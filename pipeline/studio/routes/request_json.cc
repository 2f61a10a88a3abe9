#include "pipeline/studio/routes/request_json.h"

namespace glint {

Json JsonBody(HttpBody* body) {
  constexpr std::size_t kMost_bytes = 1 << 20;
  const std::string text = body->Text(kMost_bytes);
  Json json = Json::parse(text.empty() ? "{}" : text, nullptr, false);
  if (!json.is_object()) throw HttpError{400, "found no JSON object", "reload the page"};
  return json;
}

double NumberIn(const Json& json, const std::string& key, double fallback) {
  if (!json.contains(key) || json[key].is_null()) return fallback;
  if (!json[key].is_number()) {
    throw HttpError{422, key + ": found " + json[key].dump(), "give a number"};
  }
  return json[key].get<double>();
}

std::string TextIn(const Json& json, const std::string& key, const std::string& fallback) {
  if (!json.contains(key) || json[key].is_null()) return fallback;
  if (!json[key].is_string()) {
    throw HttpError{422, key + ": found " + json[key].dump(), "give a text"};
  }
  return json[key].get<std::string>();
}

std::optional<std::array<double, 2>> PairIn(const Json& json, const std::string& key) {
  if (!json.contains(key) || json[key].is_null()) return std::nullopt;
  const Json& pair = json[key];
  if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number()) {
    throw HttpError{422, key + ": found " + pair.dump(), "give width and height"};
  }
  return std::array{pair[0].get<double>(), pair[1].get<double>()};
}

bool FlagIn(const Json& json, const std::string& key) {
  if (!json.contains(key) || !json[key].is_boolean()) {
    throw HttpError{422, key + ": found no flag", "give true or false"};
  }
  return json[key].get<bool>();
}

}  // namespace glint
