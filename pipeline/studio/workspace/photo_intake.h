// A received photograph becomes one of a capture's.
#pragma once

#include <optional>
#include <string>

#include "pipeline/studio/captures/library.h"
#include "pipeline/studio/photographs/check_queue.h"
#include "pipeline/studio/photographs/received_photo.h"

namespace glint {

struct TakenPhoto {
  std::string id;
  bool was_there = false;  // the same bytes: nothing is kept twice
};

// Keeps it, lists it in capture.toml and queues its check; under the capture's mutex. `hash` is
// what ReceivedPhoto::Finish() returned. Throws HttpError or Error; nothing of it is then there.
TakenPhoto TakeIn(const LibraryEntry& entry, const std::string& hash, ReceivedPhoto* photo,
                  CheckQueue* checks);

}  // namespace glint
