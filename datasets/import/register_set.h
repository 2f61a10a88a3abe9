// Where the sample lies in rectified views of another program, and what brings them into one frame.
#pragma once

#include <string>

#include "calib/registration/register_sample.h"
#include "datasets/import/import_set.h"

namespace glint {

// Reads the set's images, at a small size. Nothing to estimate (one view, renderings, or
// --register none): a plane at 0 and no homographies.
SampleRegistration RegisterSet(const ForeignSet& set, const ImportOptions& options,
                               const SamplePlane& plane, int threads);

// Where a registered view shows points of the sample's plane on the plane that its program
// rectified it for.
Eigen::Matrix3d RectifiedFromSample(const SampleRegistration& registration, const View& view,
                                    size_t index);

// Camera and light in the sample's frame.
View InSampleFrame(View view, const PlaneValues& sample_plane);

// For the manifest. Displacements are in texels of the views.
Json RegistrationMetrics(const SampleRegistration& registration, const SamplePlane& plane);
// A line of it for people; "" where nothing was sought or told.
std::string RegistrationText(const Json& metrics);

}  // namespace glint
