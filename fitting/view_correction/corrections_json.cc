#include "fitting/view_correction/corrections_json.h"

#include <algorithm>

#include "pipeline/contract/errors.h"

namespace glint {

Json JsonOf(const std::string& view, const ViewCorrection& correction) {
  Json columns = Json::array(), rows = Json::array();
  for (int k = 0; k < 4; ++k) {
    columns.push_back(correction.shifts.column[k]);
    rows.push_back(correction.shifts.row[k]);
  }
  return {{"name", view},
          {"light_offset_mm", correction.light_offset_mm},
          {"ambient_rgb", correction.ambient_rgb},
          {"exposure", correction.exposure},
          {"corner_columns_texel", columns},
          {"corner_rows_texel", rows}};
}

std::map<std::string, ViewCorrection> ReadCorrections(const std::filesystem::path& manifest_file,
                                                      const Json& data) {
  std::map<std::string, ViewCorrection> corrections;
  if (!data.contains("corrections")) return corrections;
  const Json& entries = data["corrections"];
  if (!entries.is_array()) {
    throw UserError(manifest_file, "data.corrections", entries.dump(), "run glint-refine again");
  }
  for (const Json& entry : entries) {
    const auto numbers = [&](const char* field, size_t count) {
      return RequireNumbers(manifest_file, entry, "data.corrections[]", field, count);
    };
    ViewCorrection correction;
    const auto light = numbers("light_offset_mm", 3), ambient = numbers("ambient_rgb", 3);
    std::copy(light.begin(), light.end(), correction.light_offset_mm.begin());
    std::copy(ambient.begin(), ambient.end(), correction.ambient_rgb.begin());
    correction.exposure = RequireNumber(manifest_file, entry, "data.corrections[]", "exposure");
    const auto columns = numbers("corner_columns_texel", 4), rows = numbers("corner_rows_texel", 4);
    std::copy(columns.begin(), columns.end(), correction.shifts.column);
    std::copy(rows.begin(), rows.end(), correction.shifts.row);
    corrections[RequireString(manifest_file, entry, "data.corrections[]", "name")] = correction;
  }
  return corrections;
}

}  // namespace glint
