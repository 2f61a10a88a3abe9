#include "pipeline/studio/captures/known_boards.h"

#include <algorithm>

#include "datasets/synth/frame_board.h"

namespace glint {

std::vector<KeptBoard> KnownBoards(const std::vector<KeptBoard>& others) {
  const std::string demo = "glint-demo";
  const BoardFile file{FrameBoard(kUsualSample_mm), std::nullopt};
  const bool is_there = std::any_of(others.begin(), others.end(), [&](const KeptBoard& other) {
    return DescriptionOf(other.file.board) == DescriptionOf(file.board);
  });
  if (is_there) return {};
  return {{IdOf("known board " + demo), demo, {}, file}};
}

}  // namespace glint
