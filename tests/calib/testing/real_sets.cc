#include "tests/calib/testing/real_sets.h"

#include <fmt/format.h>

#include <fstream>

#include "base/board/board.h"
#include "base/photos/photo.h"
#include "calib/corners/detector.h"

namespace glint::testing {

std::vector<double> ReadNumbers(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<double> numbers;
  for (double number; stream >> number;) numbers.push_back(number);
  return numbers;
}

BundleProblem ZhangProblem(const std::filesystem::path& folder) {
  const auto model = ReadNumbers(folder / "Model.txt");
  BundleProblem problem;
  problem.cameras.push_back({640, 480, {}});
  for (int i = 1; i <= 5; ++i) {
    const auto seen = ReadNumbers(folder / fmt::format("data{}.txt", i));
    BundlePhoto photo{fmt::format("CalibIm{}", i), 0, {}};
    for (size_t k = 0; 2 * k + 1 < std::min(model.size(), seen.size()); ++k) {
      // Zhang's pixels have integer centres; inches become millimetres.
      photo.corners.push_back({static_cast<int>(k),
                               {25.4 * model[2 * k], 25.4 * model[2 * k + 1]},
                               {seen[2 * k] + 0.5, seen[2 * k + 1] + 0.5}});
    }
    problem.photos.push_back(photo);
  }
  return problem;
}

BundleProblem ChessboardProblem(const std::filesystem::path& folder, const std::string& side) {
  Board board;
  board.kind = BoardKind::kCheckerboard;
  board.squares_x = 10;
  board.squares_y = 7;
  board.square_mm = 25;
  BundleProblem problem;
  problem.cameras.push_back({640, 480, {}});
  for (int i : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14}) {
    BundlePhoto photo{fmt::format("{}{:02}.jpg", side, i), 0, {}};
    const auto detection = DetectBoard(GrayFromPhoto(ReadPhoto(folder / photo.name)), board);
    for (const auto& c : detection.corners) {
      photo.corners.push_back({c.id, c.position_in_sample_mm, c.point_px});
    }
    problem.photos.push_back(photo);
  }
  return problem;
}

BundleOptions FiveTermOptions() {
  BundleOptions options;
  options.model = CameraModel::kFullOpenCv;
  options.hold = {"k4", "k5", "k6"};
  return options;
}

}  // namespace glint::testing
