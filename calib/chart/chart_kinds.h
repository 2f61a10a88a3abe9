// The charts that are found in photographs: one row each. Included by .cc files only.
#pragma once

#include <opencv2/mcc.hpp>
#include <span>
#include <string_view>

namespace glint {

// Unit: any; the first row's patches may be taller.
struct ChartKind {
  std::string_view name;
  cv::mcc::TYPECHART detected_as;
  cv::ccm::CONST_COLOR colours;
  int columns, rows;
  bool by_column;       // order of the colours: down the first column, then the next
  double patch, gap;    // side of a patch, space between two
  double first_height;  // of the patches in the first row
  double margin;        // from the outermost patches to the box that mcc finds
};

// Proportions as mcc draws them (CCheckerDraw; a test compares).
std::span<const ChartKind> ChartKinds();

}  // namespace glint
