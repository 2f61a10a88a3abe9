// How well maps explain photographs: re-rendered views against rectified photographs.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/formats/rectified_set.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/view_correction/shared_light.h"
#include "fitting/view_correction/view_correction.h"

namespace glint {

// Means over usable texels (mask ≥ 0.5) and channels.
struct ViewError {
  double mse = 0;  // of linear radiance
  double rmse = 0;
  double log_l1 = 0;  // |log(I + 0.01) − log(R + 0.01)|, eq. 2 of Gao et al. 2019
  size_t texels = 0;  // usable
};

// `rendered`: planar 3·H·W as the photograph. `ldr`: both are clipped to [0, 1] first. A view
// without usable texels gives zeros with texels = 0. Throws std::invalid_argument when sizes
// differ.
ViewError CompareView(std::span<const float> rendered, const RectifiedImage& photograph, bool ldr);

// Texels that the photograph says something of: usable ones, and those that are not for being
// clipped (ReachesLimit).
std::vector<bool> ToldTexels(const RectifiedImage& photograph, bool ldr);

// log(I + 0.01) − log(R + 0.01) [3·H·W] of the photograph and the rendering, NaN where the mask is
// below 0.5. Sizes and `ldr` as in CompareView.
std::vector<float> LogResiduals(std::span<const float> rendered, const RectifiedImage& photograph,
                                bool ldr);

// The result of fit or refine: maps, and what was found about the photographs.
struct FittedMaps {
  SvbrdfMaps maps;
  ReflectanceConvention convention;
  std::array<double, 3> light_scale_rgb{1, 1, 1};     // multiplies every light_rgb
  SharedLight shared_light;                           // of every view
  std::map<std::string, ViewCorrection> corrections;  // by view, of those that were refined from
  EnvironmentLighting environment;                    // added to every view's
};

// `path`: manifest.json of fit or refine, the folder that holds it, or svbrdf.exr alone (then the
// scale is 1 and nothing is corrected). With `most_side` above 0, maps that are larger are read at
// that size, and never whole. Throws UserError.
FittedMaps ReadFittedMaps(const std::filesystem::path& path, int most_side = 0);

// The photograph of `view`, looked up where the fit found that it belongs. Throws as
// ReadRectifiedImage() does.
RectifiedImage PhotographOfFit(const FittedMaps& fit, const RectifiedSet& set,
                               const RectifiedView& view);
// The same averaged to width × height, and never whole.
RectifiedImage PhotographOfFit(const FittedMaps& fit, const RectifiedSet& set,
                               const RectifiedView& view, int width, int height);

// Camera and light of `view` as the fit found them; environment lighting apart.
View ViewOfFit(const FittedMaps& fit, const RectifiedView& view);

// Renders `view` of `set`, as the fit found it to be lit, from the fit, at the set's size.
std::vector<float> RenderFit(const FittedMaps& fit, const RectifiedSet& set,
                             const RectifiedView& view, int threads);

// Writes FOLDER/NAME.png: photograph, rendering and four times their absolute difference, side by
// side, each clipped to [0, 1], gamma 2.2. Where the photograph says nothing, the rendering stands
// in its place, as in CompareLooks().
void WritePair(const std::filesystem::path& file, const RectifiedImage& photograph, bool ldr,
               std::span<const float> rendered);

}  // namespace glint
