#include "fitting/render/check_sizes.h"

#include <stdexcept>
#include <string>

namespace glint::kernel {

void CheckSizes(const SvbrdfMaps& maps, const SamplePlane& plane) {
  const auto size = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  if (maps.width < 1 || maps.height < 1 || maps.width != plane.width ||
      maps.height != plane.height) {
    throw std::invalid_argument("rendering: the maps are " + size(maps.width, maps.height) +
                                " texels, the sample plane is " + size(plane.width, plane.height) +
                                "; give maps of the plane's size");
  }
  if (maps.planes.size() != kSvbrdfPlanes * maps.texels()) {
    throw std::invalid_argument("rendering: maps of " + size(maps.width, maps.height) + " hold " +
                                std::to_string(maps.planes.size()) + " values instead of " +
                                std::to_string(kSvbrdfPlanes * maps.texels()));
  }
}

}  // namespace glint::kernel
