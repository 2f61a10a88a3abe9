// The sample's plane among the points of a COLMAP model: a step of sample_frame.h.
#pragma once

#include <string>
#include <vector>

#include "calib/capture/sample_frame.h"

namespace glint {

// In the model's frame, its normal toward the cameras; `plane_points` returns how many points it
// was sought in. Throws UserError: no points, no plane, cameras on both of its sides.
PlaneFit FindSamplePlane(const Capture& capture, const PosedModel& model,
                         const FrameOptions& options, size_t* plane_points);

// Throws UserError where the model does not hold the photograph.
const PosedPhoto& PhotoNamed(const Capture& capture, const std::vector<PosedPhoto>& photos,
                             const std::string& name);

double MedianOf(std::vector<double> values);  // the upper one of an even number; not empty

}  // namespace glint
