#include "pipeline/studio/photographs/boards_shown.h"

#include <algorithm>

#include "calib/capture/reduced_photo.h"
#include "calib/corners/detector.h"
#include "pipeline/studio/photographs/photo_check.h"

namespace glint {
namespace {

struct ShownBoard {
  std::size_t index = 0;
  // Corners found, times their share of all the board's corners: a frame explains its photograph
  // better than the whole board does, of which a few chance corners are found in the window.
  double score = 0;
};

}  // namespace

std::vector<std::size_t> BoardsShown(const std::filesystem::path& photo,
                                     const std::vector<Board>& boards) {
  int reduction = 1;
  const GrayImage gray = GrayFromPhoto(ReadReducedPhoto(photo, kCheck_px, &reduction));
  DetectorOptions options;
  options.explain_mismatch = false;
  std::vector<ShownBoard> shown;
  for (std::size_t i = 0; i < boards.size(); ++i) {
    const BoardDetection detection = DetectBoard(gray, boards[i], options);
    if (detection.corners.empty() || !detection.position_known) continue;
    const auto found = static_cast<double>(detection.corners.size());
    shown.push_back({i, found * found / static_cast<double>(BoardCorners(boards[i]).size())});
  }
  std::stable_sort(shown.begin(), shown.end(),
                   [](const ShownBoard& a, const ShownBoard& b) { return a.score > b.score; });
  std::vector<std::size_t> indices;
  for (const ShownBoard& one : shown) {
    if (2 * one.score >= shown[0].score) indices.push_back(one.index);  // else a chance resemblance
  }
  return indices;
}

}  // namespace glint
