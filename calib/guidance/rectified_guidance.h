// The verdict on views that another program rectified.
#pragma once

#include "calib/guidance/verdict.h"
#include "pipeline/contract/rectified_set.h"

namespace glint {

// By positions alone: every view counts as showing the whole sample. The set must have a view.
Verdict JudgeRectifiedSet(const RectifiedSet& set);

}  // namespace glint
