#include "pipeline/viewer/viewer_bundle.h"

namespace glint {
namespace {

// With one byte more, so that it is never of no size.
constexpr unsigned char kBytes[] = {
#include "viewer.bundle.js.inc"
    0};

}  // namespace

std::string_view ViewerBundle() {
  return {reinterpret_cast<const char*>(kBytes), sizeof kBytes - 1};
}

}  // namespace glint
