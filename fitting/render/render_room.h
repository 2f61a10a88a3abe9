// What maps reflect of a room.
#pragma once

#include "fitting/reflectance/convention.h"
#include "fitting/reflectance/room_light.h"
#include "fitting/reflectance/svbrdf_maps.h"
#include "fitting/reflectance/view.h"

namespace glint {

// Adds what every texel reflects of `room` toward the view's camera, times its exposure, to
// `rgb_planar` (3·height·width values, as RenderView() gives). Any number of threads gives the same
// bits. Throws std::invalid_argument unless the maps' size is the plane's.
void AddRoomLight(const RoomLight& room, const SvbrdfMaps& maps, const SamplePlane& plane,
                  const View& view, const ReflectanceConvention& convention, float* rgb_planar,
                  int threads = 1);

}  // namespace glint
