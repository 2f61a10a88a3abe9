// One photograph to one rectified view.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/calibration.h"
#include "base/formats/rectified_set.h"
#include "rectify/resample/resample.h"
#include "rectify/views/rectify_options.h"

namespace glint {

// Where the texels of a view went; fractions of all texels.
struct ViewCounts {
  double usable = 0, outside = 0, saturated = 0, masked = 0;
  double black = 0;             // of the usable ones: radiance below 1e-4 in every channel
  double pixels_per_texel = 0;  // side of a texel at the sample's centre in the photo, pixels
};

Json ToJson(const ViewCounts& counts);

// Camera and light of a calibrated photo in the sample frame, with the calibration's power and an
// exposure of 1; lights corrected as the view's colours are. `ambient` holds where the calibration
// tells none. Throws UserError when either
// lies behind the sample.
View ViewOf(const Calibration& calibration, const CalibratedPhoto& photo,
            const std::vector<double>& ambient, const std::filesystem::path& calibration_file);

// Counts the texels of a view and makes status into a mask. Throws UserError naming `file` when no
// texel is usable (sample outside of the photo, all saturated, all under the frame) or all are
// black.
RectifiedImage MaskView(ResampledView view, const std::filesystem::path& file, ViewCounts* counts);

// What a frame covers of rows of the plane, as MaskFrame gives it; empty: no frame.
using FrameStatus = std::function<std::vector<TexelStatus>(const SamplePlane& rows)>;

// ResampleToPlane, MaskView.
RectifiedImage RectifyPhoto(const LinearPhoto& photo, const PlaneProjection& projection,
                            const SamplePlane& plane, const ResampleOptions& options,
                            const FrameStatus& frame, const std::filesystem::path& file,
                            ViewCounts* counts);

// The same by rows from the top, of which `take` is given kRowsAtOnce, in the end fewer: a view of
// 16384² texels need not be whole in memory. Throws at the end where RectifyPhoto throws.
inline constexpr int kRowsAtOnce = 512;
ViewCounts RectifyByRows(const LinearPhoto& photo, const PlaneProjection& projection,
                         const SamplePlane& plane, const ResampleOptions& options,
                         const FrameStatus& frame, const std::filesystem::path& file,
                         const std::function<void(const RectifiedImage& rows)>& take);

}  // namespace glint
