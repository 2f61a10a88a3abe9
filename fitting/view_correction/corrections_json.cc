#include "fitting/view_correction/corrections_json.h"

#include <algorithm>

#include "base/errors/errors.h"

namespace glint {

Json JsonOf(const std::string& view, const ViewCorrection& correction) {
  Json columns = Json::array(), rows = Json::array();
  for (int k = 0; k < 4; ++k) {
    columns.push_back(correction.shifts.column[k]);
    rows.push_back(correction.shifts.row[k]);
  }
  return {{"name", view},
          {"light_offset_mm", correction.light_offset_mm},
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
    const auto light = numbers("light_offset_mm", 3);
    std::copy(light.begin(), light.end(), correction.light_offset_mm.begin());
    correction.exposure = RequireNumber(manifest_file, entry, "data.corrections[]", "exposure");
    const auto columns = numbers("corner_columns_texel", 4), rows = numbers("corner_rows_texel", 4);
    std::copy(columns.begin(), columns.end(), correction.shifts.column);
    std::copy(rows.begin(), rows.end(), correction.shifts.row);
    corrections[RequireString(manifest_file, entry, "data.corrections[]", "name")] = correction;
  }
  return corrections;
}

Json JsonOf(const SharedLight& shared) {
  const SharedLightValues& values = shared.values;
  return {{"offset_mm",
           {values[kOffsetX] * shared.distance_mm, values[kOffsetY] * shared.distance_mm, 0}},
          {"beam", {values[kBeamX], values[kBeamY]}},
          {"distance_power", values[kDistancePower]},
          {"toe", kToeUnit * values[kSharedToe]},
          {"shoulder", values[kSharedShoulder]},
          {"distance_mm", shared.distance_mm}};
}

SharedLight ReadSharedLight(const std::filesystem::path& manifest_file, const Json& data) {
  SharedLight shared;
  if (!data.contains("shared_light")) return shared;
  const Json& light = data["shared_light"];
  const auto offset = RequireNumbers(manifest_file, light, "data.shared_light", "offset_mm", 3);
  const auto beam = RequireNumbers(manifest_file, light, "data.shared_light", "beam", 2);
  shared.distance_mm = RequireNumber(manifest_file, light, "data.shared_light", "distance_mm");
  if (!(shared.distance_mm > 0)) {
    throw UserError(manifest_file, "data.shared_light.distance_mm", light["distance_mm"].dump(),
                    "run glint-refine again");
  }
  const auto number = [&](const char* field) {
    return RequireNumber(manifest_file, light, "data.shared_light", field);
  };
  // Manifests that are older than the curve have none.
  const double toe = light.contains("toe") ? number("toe") : 0;
  const double shoulder = light.contains("shoulder") ? number("shoulder") : 0;
  shared.values = {offset[0] / shared.distance_mm,
                   offset[1] / shared.distance_mm,
                   beam[0],
                   beam[1],
                   number("distance_power"),
                   toe / kToeUnit,
                   shoulder};
  return shared;
}

Json JsonOf(const EnvironmentLighting& environment) {
  return {{"radiance_rgb", environment.radiance_rgb}};
}

Json JsonOf(const SystematicDeviations& deviations) {
  return {{"diffuse_relative", deviations.diffuse},
          {"specular_relative", deviations.specular},
          {"roughness", deviations.roughness},
          {"slope", deviations.slope}};
}

EnvironmentLighting ReadEnvironmentLighting(const std::filesystem::path& manifest_file,
                                            const Json& data) {
  EnvironmentLighting environment;
  if (!data.contains("room_light")) return environment;
  const Json& terms =
      RequireField(manifest_file, data["room_light"], "data.room_light", "radiance_rgb");
  if (!terms.is_array() || !AreEnvironmentTerms(terms.size())) {
    throw UserError(manifest_file, "data.room_light.radiance_rgb", terms.dump(),
                    "run glint-refine again");
  }
  environment.radiance_rgb.resize(terms.size());
  for (size_t j = 0; j < terms.size(); ++j) {
    const auto rgb = RequireNumbers(manifest_file, Json{{"term", terms[j]}},
                                    "data.room_light.radiance_rgb[]", "term", 3);
    std::copy(rgb.begin(), rgb.end(), environment.radiance_rgb[j].begin());
  }
  return environment;
}

}  // namespace glint
