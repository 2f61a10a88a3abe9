// From another program's rectified views to what the rectify stage would have written.
#pragma once

#include <filesystem>
#include <string>

#include "base/formats/rectified_set.h"
#include "base/programs/options.h"
#include "base/programs/program.h"
#include "base/programs/stage.h"
#include "datasets/import/foreign_set.h"

namespace glint {

struct ImportOptions {
  int size = 0;  // width of the views in texels; 0: as the images are
  int crop = 0;  // the sample is the central crop × crop pixels; 0: as the layout says
  std::string registration = "auto";  // or none
  std::string convention;             // empty: as the source says
  std::string light_power;            // "estimate", a number, "r,g,b"; empty: as the source says
  std::string encoding;               // empty: as the source says
  double saturation_level = 0.995;  // stored value from which 8 and 16 bit images count as clipped
  double float_saturation_level = 0;  // the same for floats; 0: they never clip
};

void AddImportOptions(OptionSet* set, ImportOptions* options);

// Lets the options override what the source says. Throws UserError naming the option.
void ApplyOptions(const ImportOptions& options, ForeignSet* set);

// All files whose contents the result depends on.
std::vector<std::filesystem::path> ImportInputs(const ForeignSet& set);

struct ImportSummary {
  RectifiedSet set;
  Json metrics;
};

// Linearises, crops and resamples the images, writes the views as outputs of `stage` (a stage
// "rectify") and commits it. Throws UserError: images that are unreadable, of different sizes, or
// of a shape that does not fit size_mm.
ImportSummary ImportSet(const ForeignSet& set, const ImportOptions& options,
                        const CommonOptions& common, Stage* stage);

// The capture.toml of an imported set: no photographs and no board, so that a run starts at fit.
std::string ImportedCaptureToml(const ForeignSet& set, const SamplePlane& plane);

// The views' extent and size in texels, from the first image's header.
SamplePlane ImportedPlane(const ForeignSet& set, const ImportOptions& options);

}  // namespace glint
