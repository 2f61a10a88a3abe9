// What a capture's photographs say of its board.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "pipeline/studio/captures/boards.h"
#include "pipeline/studio/captures/capture_state.h"
#include "pipeline/studio/photographs/check_queue.h"

namespace glint {

struct BoardOffer {
  bool shows_another = false;     // in some photograph, than the capture's
  std::vector<KeptBoard> boards;  // that photographs show, the likeliest first
};

// Of `boards`; nothing where the capture's own board was found in a photograph. Takes up to some
// seconds.
BoardOffer BoardsToOffer(const CaptureState& state, const std::vector<KeptBoard>& boards,
                         CheckQueue* checks);

// Places of photographs that are left out while the capture's board was not found in them.
std::set<std::string> LeftOutForBoard(const CaptureState& state, CheckQueue* checks);

}  // namespace glint
