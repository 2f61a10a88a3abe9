// Photographs and initial maps of a capture as refinement takes them: by rows, thinned out or
// smaller. Only what is asked for is ever in memory.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/formats/deviation_rows.h"
#include "base/formats/svbrdf_rows.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/rectified_photographs/rectified_photographs.h"
#include "fitting/refine/refine.h"
#include "fitting/refine/shared_detail.h"
#include "fitting/shadows/cast_shadows.h"
#include "fitting/view_correction/view_correction.h"

namespace glint {

class SampleSource {
 public:
  // `maps_file`: an svbrdf.exr, which is resampled to the set's size; its diffuse weight becomes
  // that of the convention. `deviations_file`: of those maps; empty: not known. Throws UserError;
  // so do all that read.
  SampleSource(const RectifiedSet& set, const std::vector<RectifiedView>& views,
               const Vec3d& light_scale_rgb, std::filesystem::path maps_file,
               const std::filesystem::path& deviations_file);

  struct Part {
    PhotographSet photographs;
    SvbrdfMaps start;
    SvbrdfDeviations start_sd;  // empty: not known

    // What of it refinement takes; this must outlive it.
    RefineProblem Problem() const;
  };
  // From now on Rows() and Every() give photographs as the corrections say.
  void Correct(ViewCorrections corrections);
  // From now on Rows() and Every() give photographs without texels that the sample's own relief, as
  // the initial maps have it, hides from the light (cast_shadows.h). For lights that were moved.
  void MaskShadows(int threads);

  // From now on Rows() and Every() give photographs with the detail that sharper ones show, as the
  // sample's middle rows tell it; they and Views() say what their blurs hide.
  void CompareSharpness(const RefineOptions& options, int threads);

  // With views alone, as said.
  PhotographSet Views() const;
  const SamplePlane& plane() const { return photographs_.plane(); }
  Part Rows(int first_row, int rows, int threads);
  // The texel in the middle of every stride × stride.
  Part Every(int stride, int threads);
  // Averages, not corrected; without deviations of the maps.
  Part Downsampled(int width, int height, int threads);

 private:
  PhotographSet PhotographRows(int first_row, int rows, int threads);
  PhotographSet CorrectedRows(int first_row, int rows, int threads);
  HidingRelief ReliefOfMaps(int threads);
  PhotographSet SharpenedRows(int first_row, int rows, int threads);

  std::filesystem::path maps_file_;
  ResampledSvbrdf maps_;
  std::optional<ResampledDeviations> deviations_;
  RectifiedPhotographs photographs_;
  ViewCorrections corrections_;  // no views: none
  SharedDetail shared_detail_;
  // By photograph, of all texels: those in shadow. Empty: none.
  std::vector<std::vector<bool>> shadows_;
};

}  // namespace glint
