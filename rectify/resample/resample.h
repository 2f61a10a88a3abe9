// From a photograph to the top view of the sample, in one resampling.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/camera/camera_model.h"
#include "base/formats/colour_correction.h"
#include "base/linearize/linear_photo.h"
#include "base/reflectance/view.h"
#include "rectify/resample/filter_kernel.h"
#include "rectify/resample/plane_projection.h"

namespace glint {

struct ResampleOptions {
  FilterKind filter = FilterKind::kSharp;
  // How far, in pixels, the texel's own area may stick out of the picture and still count as
  // inside.
  double border_px = 1e-3;
  int threads = 1;  // never changes a value
  // Every texel is the pixel under its centre: of planes of which TexelsArePixels() holds.
  bool pixels_as_they_are = false;
  // The lens's fall-off, which is divided out; its principal point and size are those of the photo.
  std::optional<Camera> vignetting;
  // What R, G, B are multiplied by: a white balance that changed between photographs.
  std::array<double, 3> gain_rgb{1, 1, 1};
  // What a chart told of the camera's colours, applied to what the gains leave.
  std::optional<ColourCorrection> colour;
};

enum class TexelStatus : uint8_t {
  kUsable,
  kOutside,    // not (wholly) in the picture, behind the camera, or where the lens model folds over
  kSaturated,  // a pixel that the filter reached had clipped
  kMasked      // ruled out by the caller
};

// Rows top (+y) to bottom.
struct ResampledView {
  int width = 0, height = 0;
  std::vector<float> rgb;           // planar [3·H·W], linear radiance; 0 where kOutside
  std::vector<TexelStatus> status;  // [H·W]
};

// Whether every texel is a pixel of its own, as in a fixed camera's whole picture: the whole
// plane's corners are an upright rectangle of the picture, as many pixels apart as texels, to a
// twentieth of a pixel.
bool TexelsArePixels(const PlaneProjection& projection, const SamplePlane& plane);

// Per texel: the image of its centre, the ellipse its area covers there, and the weighted mean of
// the linear pixel values under the kernel stretched over that ellipse. Never aliases when the
// photo is finer than the texels, at any tilt; interpolates when it is coarser; takes pixels as
// they are where asked to. Weights are
// normalised, so that constants stay constants; negative results (the kernel's lobes beside a
// highlight; colours beyond Rec.709) become 0. Threaded by tiles; the result does not depend on the
// number of threads. With `vignetting`, gains or `colour` the value is what reached the lens; a
// photo of 8 or 16 bit keeps 1 as its ceiling (what clips says "at least 1", and later stages
// compare with renderings clamped to 1), so values above it become 1, and saturated texels stay as
// they are. Texels marked kMasked in `status_before` (empty, or [H·W]) are passed over.
ResampledView ResampleToPlane(const LinearPhoto& photo, const PlaneProjection& projection,
                              const SamplePlane& plane, const ResampleOptions& options,
                              const std::vector<TexelStatus>& status_before = {});

}  // namespace glint
