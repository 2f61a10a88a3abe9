#include "pipeline/export/material_rows.h"

#include <algorithm>
#include <utility>

#include "base/reflectance/border.h"

namespace glint {

MaterialRows::MaterialRows(std::filesystem::path svbrdf_exr, int border)
    : file_(std::move(svbrdf_exr)), border_(border), reader_(file_, &convention_) {}

SvbrdfMaps MaterialRows::Rows(int first_row, int rows) {
  const int inset = BorderInset(width(), height(), border_);
  const auto inner = [&](int row) { return std::clamp(row, inset, height() - 1 - inset); };
  const int first = inner(first_row), last = inner(first_row + rows - 1);
  const SvbrdfMaps from = reader_.Read(first, last - first + 1);
  if (inset == 0) return from;
  SvbrdfMaps maps(width(), rows);
  for (int plane = 0; plane < kSvbrdfPlanes; ++plane) {
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < width(); ++column) {
        maps.at(plane, row, column) = from.at(plane, inner(first_row + row) - first,
                                              std::clamp(column, inset, width() - 1 - inset));
      }
    }
  }
  return maps;
}

SvbrdfMaps MaterialRows::AtSize(int width, int height) {
  SvbrdfMaps maps = ResampledSvbrdf(file_, width, height).Read(0, height);
  ContinueBorder(&maps, border_);
  return maps;
}

}  // namespace glint
