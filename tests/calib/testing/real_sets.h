// Public calibration sets that are no part of the repository; see tests/support/data_folder.h.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint::testing {

std::vector<double> ReadNumbers(const std::filesystem::path& file);

// Z. Zhang 1998: five images, his own corners (data1.txt … data5.txt, Model.txt).
BundleProblem ZhangProblem(const std::filesystem::path& folder);

// OpenCV's 13 photographs of a 9 × 6 chessboard by one camera of a pair ("left", "right"), with our
// own corners.
BundleProblem ChessboardProblem(const std::filesystem::path& folder, const std::string& side);

// Two radial terms and two tangential, and k3: OpenCV's five terms of the publication.
BundleOptions FiveTermOptions();

}  // namespace glint::testing
