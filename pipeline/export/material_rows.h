// The maps that are exported, by rows or smaller: those of 16384² texels are never whole in memory.
#pragma once

#include <filesystem>

#include "base/formats/svbrdf_rows.h"
#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"

namespace glint {

class MaterialRows {
 public:
  // `border`: rings of outermost texels that are replaced (ContinueBorder). Throws UserError; so do
  // all that read.
  MaterialRows(std::filesystem::path svbrdf_exr, int border);

  int width() const { return reader_.width(); }
  int height() const { return reader_.height(); }
  const ReflectanceConvention& convention() const { return convention_; }
  // Rows first_row … first_row + rows − 1.
  SvbrdfMaps Rows(int first_row, int rows);
  // All, resampled to the size.
  SvbrdfMaps AtSize(int width, int height);

 private:
  std::filesystem::path file_;
  int border_;
  ReflectanceConvention convention_;
  SvbrdfReader reader_;
};

}  // namespace glint
