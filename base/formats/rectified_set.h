// What `rectify` and `glint-import` write and all later stages read: linear top views of the sample
// with the geometry of camera and light.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/files/json.h"
#include "base/formats/manifest.h"
#include "base/reflectance/view.h"

namespace glint {

struct RectifiedView {
  std::string name;     // "view_000"
  std::string file;     // EXR, relative to the manifest's folder: R, G, B, mask.Y
  std::string photo;    // the photograph it came from, as in capture.toml's folder
  bool ldr = true;      // the photograph clips at radiance 1
  bool linear = false;  // and was stored as radiance (RAW, float), without a camera's curve
  View view;
  // Side of a texel at the sample's centre in the photograph, which was resampled; not known of
  // imported pictures and of a fixed camera's whose pixels are the texels.
  std::optional<double> pixels_per_texel;
  // Standard deviation by which lens, focus and pixel spread a point of the photograph, in its
  // pixels, where calibration measured it; resampling comes on top.
  std::optional<double> blur_px;

  // Through a curve that is known more or less.
  bool encoded() const { return ldr && !linear; }
};

struct RectifiedSet {
  std::filesystem::path manifest_file;
  SamplePlane plane;
  ReflectanceConvention convention;
  bool light_power_known =
      true;  // false: light_rgb is a first guess, common factor to be estimated
  // The camera stood still and the light was moved, to directions that are given.
  bool fixed_camera = false;
  // Standard deviation of the flash's position, where calibration estimated it.
  std::optional<double> light_sd_mm;
  std::vector<RectifiedView> views;
};

// What views are called that have no better name: "view_007".
std::string ViewName(size_t index);

// Values of one view: `rgb` planar [3·H·W], linear; `mask` [H·W], 1 = usable.
struct RectifiedImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
  std::vector<float> mask;
};

// The "data" object of the rectify manifest.
Json ToJson(const RectifiedSet& set);

// The manifest of the views that fitting reads, or the stage `reader` (stages.h): that of the last
// stage before it that gives views and has a result in `work`, CAPTURE/glint. Where none has, that
// of the last one.
std::filesystem::path ViewsManifest(const std::filesystem::path& work,
                                    std::string_view reader = {});
// The manifest of the views with which imported and synthetic sets begin.
std::filesystem::path ImportedViewsManifest(const std::filesystem::path& work);

// Reads and checks the manifest of a stage that gives views, without its images. Throws UserError.
RectifiedSet ReadRectifiedSet(const std::filesystem::path& manifest_file);

// Throws UserError when size or channels do not fit the set.
RectifiedImage ReadRectifiedImage(const RectifiedSet& set, const RectifiedView& view);
// Makes texels usable that an LDR photograph shows as fully clipped (mask 0, a channel at 1):
// compared with renderings clamped to [0, 1] (eq. 2) they say that the highlight is at least that
// bright, and where sharp highlights clip they are all that is known of gloss. Texels that are only
// partly clipped stay masked: their average is biased.
void AdmitClippedTexels(const RectifiedView& view, RectifiedImage* image);

void WriteRectifiedImage(const std::filesystem::path& file, const RectifiedImage& image,
                         const RectifiedSet& set, const RectifiedView& view);

// Views named by `only` (empty: all) less those named by `exclude`; names are a view's name or the
// photograph's file name. Throws UserError for a name that no view has, or when none is left.
std::vector<RectifiedView> SelectViews(const RectifiedSet& set,
                                       const std::vector<std::string>& only,
                                       const std::vector<std::string>& exclude);

}  // namespace glint
