// The verdict on views that another program rectified.
#pragma once

#include "base/formats/rectified_set.h"
#include "calib/guidance/verdict.h"

namespace glint {

// By positions alone: every view counts as showing the whole sample. The set must have a view.
Verdict JudgeRectifiedSet(const RectifiedSet& set);

}  // namespace glint
