// Fields of a manifest as rows of a table: the one place for a field's name, meaning and value.
// docs/manifest.md has the same rows; a test compares them, and writes the page where GLINT_UPDATE
// is set.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "base/files/json.h"

namespace glint {

template <class Result>
struct ManifestField {
  const char* name;
  const char* meaning;  // in Markdown
  Json (*value)(const Result& result);
};

template <class Result>
Json FieldsOf(const Result& result, std::span<const ManifestField<Result>> fields) {
  Json json = Json::object();
  for (const ManifestField<Result>& field : fields) json[field.name] = field.value(result);
  return json;
}

// Rows of a Markdown table.
template <class Result>
std::string FieldRows(std::span<const ManifestField<Result>> fields) {
  std::string rows;
  for (const ManifestField<Result>& field : fields) {
    rows += std::string("| `") + field.name + "` | " + field.meaning + " |\n";
  }
  return rows;
}

// null: not known, or without bound.
inline Json KnownOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace glint
