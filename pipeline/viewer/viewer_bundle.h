// The relighting viewer's JavaScript, for a page to run from a <script> of its own. It finds the
// elements that pipeline/report/viewer_section.h makes.
#pragma once

#include <string_view>

namespace glint {

// Empty: this build has no viewer.
std::string_view ViewerBundle();

}  // namespace glint
