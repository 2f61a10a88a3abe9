// Rectified views made straight from maps, without a camera in between: the experiments of Gao et
// al. 2019 ("DIR"), and inputs for tests of the fitting. On disk they are a capture whose stage
// "rectify" is done:
//
//   OUT/capture.toml   OUT/photos/view_000.png (8 bits) or .exr (float)
//   OUT/glint/rectify/manifest.json + view_000.exr …   OUT/truth/svbrdf.exr
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/formats/rectified_set.h"
#include "base/programs/options.h"
#include "base/programs/program.h"
#include "base/reflectance/view.h"
#include "datasets/synth/discrepancy.h"
#include "datasets/synth/disturbance.h"
#include "datasets/synth/material_source.h"
#include "datasets/synth/sensor.h"

namespace glint {

struct ViewSetOptions {
  int count = 5;
  // dir: DIR's synthetic geometry (DirView in view.h), reflectance convention dir2019.
  // photo: the poses, flash and exposure of a planned phone capture (capture_plan.h) of a sample of
  // 100 mm, convention photograph.
  // flash: as published flash captures are taken (nine_photographs): a sample of 100 mm, the camera
  // 3 to 5 half-widths away and tilted by at most 20°, its flash 12 mm beside the lens; convention
  // photograph.
  std::string rule = "dir";
  // 8: radiance is clipped to [0, 1], encoded, rounded to 8 bits, and decoded again, as a
  // photograph that was read back. float: left as it is.
  std::string bits = "8";
  // Encoding that the 8 bits are spaced evenly in. DIR's paper speaks of "8-bit linear images",
  // which is `linear`; photographs are gamma2.2.
  std::string encoding = "gamma2.2";
  // Every photograph is exposed longer by 2^stops; the manifest says so.
  double exposure_stops = 0;
  // Above 0 (rule dir only) there is no top view: every camera stands this much to 10° more off the
  // normal, at DIR's height.
  double least_tilt_deg = 0;
  Disturbance disturbance;
  // What the reflectance model does not express, at this strength (discrepancy.h).
  double discrepancy = 0;
};

// Adds all of them to a program's options.
void AddViewSetOptions(ViewSetOptions* options, OptionSet* set);

// The geometry alone. Sets of one seed are nested: the first views of a longer set are the shorter
// set (rule photo: up to 64, since a capture's exposure is fixed by all its photographs).
struct PlannedViews {
  SamplePlane plane;
  ReflectanceConvention convention;
  std::vector<View> views;  // as the manifest has them
  // How the photographs really are taken: as `views`, but for the disturbance.
  std::vector<View> taken;
  std::vector<CornerShifts> shifts;
  EnvironmentLight environment;
  Discrepancy discrepancy;
  DrawnDiscrepancy drawn_discrepancy;
};
// Throws UserError.
PlannedViews PlanViews(const ViewSetOptions& options, std::uint64_t seed, int width, int height);

// One view as its photograph shows it; every texel is usable, clipped ones too (a clipped value
// says that the radiance is at least 1, and eq. 2 compares with clipped renderings).
RectifiedImage RenderPlannedView(const SvbrdfMaps& maps, const PlannedViews& planned, int index,
                                 const ViewSetOptions& options, int threads);

// Writes the capture; keeps a rectify result that is up to date. Throws UserError,
// EnvironmentError.
void WriteViewSet(const std::filesystem::path& folder, const MaterialSource& material,
                  const ViewSetOptions& options, const CommonOptions& common);

}  // namespace glint
