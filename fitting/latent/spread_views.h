// A few photographs that stand for many.
#pragma once

#include <vector>

#include "base/formats/rectified_set.h"

namespace glint {

// At most `most` of the views, in their order: the first whose half vector is nearest to the
// normal, each further one where its half vector is farthest from those that are there (Gonzalez
// 1985). All of them where they are no more than that.
std::vector<RectifiedView> SpreadViews(const std::vector<RectifiedView>& views, size_t most);

}  // namespace glint
