// The whole of an export: maps by rows, material files from maps of a size that they can hold.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/programs/stage.h"
#include "pipeline/export/export_maps.h"
#include "pipeline/export/material_formats.h"

namespace glint {

// What is exported.
struct ExportTask {
  std::filesystem::path maps_manifest;  // of refine, fit or tile; svbrdf.exr beside it
  std::array<double, 2> size_mm{0, 0};
  bool repeats = false;
  int rows_at_once = 0;         // in memory; 0: as memory allows; never changes a value
  std::string metals = "rare";  // how the maps were found: base/reflectance/material_kinds.h
};

// Writes all files as outputs of `stage`; the manifest's data. Throws UserError, EnvironmentError.
Json ExportMaterial(const ExportTask& task, const ExportOptions& options,
                    const std::vector<MaterialFormat>& formats, int threads, Stage* stage);

}  // namespace glint
