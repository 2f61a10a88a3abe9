#include "pipeline/studio/workspace/board_offer.h"

#include <algorithm>
#include <filesystem>

#include "base/errors/errors.h"
#include "pipeline/studio/captures/photo_list.h"
#include "pipeline/studio/photographs/boards_shown.h"
#include "pipeline/studio/workspace/photo_review.h"

namespace glint {
namespace {

// Another board than the capture's, of each description one. Nobody has hundreds of boards; whoever
// has would wait.
std::vector<KeptBoard> OthersAmong(const std::vector<KeptBoard>& boards, const Board& own) {
  constexpr size_t kMost = 30;
  std::set<std::string> seen = {DescriptionOf(own)};
  std::vector<KeptBoard> others;
  for (const KeptBoard& board : boards) {
    if (others.size() < kMost && seen.insert(DescriptionOf(board.file.board)).second) {
      others.push_back(board);
    }
  }
  return others;
}

struct PhotosWithoutBoard {
  std::vector<std::filesystem::path> files;
  bool show_another = false;
};

// Photographs that can be read and do not show the capture's board; none where one does.
PhotosWithoutBoard WithoutBoard(const CaptureState& state, CheckQueue* checks) {
  PhotosWithoutBoard without;
  for (const StudioPhoto& photo : PhotosOf(state)) {
    const CheckedPhoto one = checks->Peek(photo.file, TaskOf(state));
    if (one.state != CheckState::kDone || !one.check->unreadable.empty()) continue;
    if (one.check->board_found) return {};
    without.files.push_back(photo.file);
    without.show_another |= one.check->mismatch;
  }
  return without;
}

std::vector<KeptBoard> ShownIn(const std::filesystem::path& photo,
                               const std::vector<KeptBoard>& boards) {
  std::vector<Board> described;
  for (const KeptBoard& board : boards) described.push_back(board.file.board);
  std::vector<KeptBoard> shown;
  try {
    for (const size_t index : BoardsShown(photo, described)) shown.push_back(boards[index]);
  } catch (const Error&) {  // it has gone meanwhile
  }
  return shown;
}

}  // namespace

BoardOffer BoardsToOffer(const CaptureState& state, const std::vector<KeptBoard>& boards,
                         CheckQueue* checks) {
  constexpr size_t kMostPhotos = 3;
  if (!TaskOf(state).board) return {};
  const PhotosWithoutBoard photos = WithoutBoard(state, checks);
  const std::vector<KeptBoard> others = OthersAmong(boards, state.capture->board);
  BoardOffer offer;
  offer.shows_another = photos.show_another;
  for (size_t i = 0; i < std::min(photos.files.size(), kMostPhotos); ++i) {
    offer.boards = ShownIn(photos.files[i], others);
    if (!offer.boards.empty()) break;
  }
  return offer;
}

std::set<std::string> LeftOutForBoard(const CaptureState& state, CheckQueue* checks) {
  std::set<std::string> places;
  for (const StudioPhoto& photo : PhotosOf(state)) {
    if (!photo.left_out) continue;
    const CheckedPhoto one = checks->Peek(photo.file, TaskOf(state));
    if (one.state != CheckState::kDone || !one.check->unreadable.empty()) continue;
    if (!one.check->board_found) places.insert(photo.place);
  }
  return places;
}

}  // namespace glint
