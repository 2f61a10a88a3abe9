// The photographs of a rectified set as fitting takes them: whole, by rows, or smaller. Only what
// is asked for is ever in memory.
#pragma once

#include <vector>

#include "base/formats/rectified_rows.h"
#include "fitting/photographs/photographs.h"

namespace glint {

class RectifiedPhotographs {
 public:
  // `light_scale_rgb`: what every view's power is multiplied with. Throws UserError when a file
  // does not fit the set; so do all that read.
  RectifiedPhotographs(RectifiedSet set, std::vector<RectifiedView> views,
                       const Vec3d& light_scale_rgb = {1, 1, 1});

  const std::vector<RectifiedView>& views() const { return views_; }
  const SamplePlane& plane() const { return set_.plane; }

  // With views alone.
  PhotographSet WithoutPixels() const;
  // Rows first_row … first_row + rows − 1 of all photographs; clipped texels are admitted
  // (AdmitClippedTexels).
  PhotographSet Rows(int first_row, int rows, int threads);
  PhotographSet Whole(int threads) { return Rows(0, plane().height, threads); }
  // As glint::Downsampled().
  PhotographSet Downsampled(int width, int height, int threads);

 private:
  Photograph ReadRows(size_t photograph, int first_row, int rows);

  RectifiedSet set_;
  std::vector<RectifiedView> views_;
  std::vector<RectifiedReader> readers_;
};

}  // namespace glint
