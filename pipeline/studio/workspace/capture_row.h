// A capture as a row of the library.
#pragma once

#include <vector>

#include "base/files/json.h"
#include "pipeline/studio/captures/capture_state.h"
#include "pipeline/studio/captures/library.h"
#include "pipeline/studio/captures/photo_list.h"
#include "pipeline/studio/runs/runs.h"

namespace glint {

// {id, name, kind, size_mm, photographs, verdict, status, thumbnail: null, changed_s}
Json RowJson(const LibraryEntry& entry, const CaptureState& state,
             const std::vector<StudioPhoto>& photos, RunManager* runs);

}  // namespace glint
