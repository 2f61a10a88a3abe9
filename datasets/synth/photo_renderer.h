// Renders the photographs of a planned capture as linear radiance, anti-aliased.
//
// What a pixel sees is the average over its footprint. Inside the sample it is averaged over a grid
// of shaded points half a texel of the maps apart (bilinear between texels), so neither
// relief nor highlights alias; the sheet is flat paper and ink, so a pixel is subdivided only where
// an edge passes through it. Without a board the table has a pattern, smooth over a millimetre.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "base/reflectance/svbrdf_maps.h"
#include "base/reflectance/view.h"
#include "datasets/synth/capture_plan.h"

namespace glint {

class PhotoRenderer {
 public:
  // Keeps a reference to `plan`; `maps` cover the whole sample (pixel centres). `threads` serve the
  // undistortion of the camera's pixel grid, which is done once. Throws ComputationError when the
  // lens cannot be inverted somewhere in the image.
  PhotoRenderer(const CapturePlan& plan, const SvbrdfMaps& maps, int threads);

  // Linear radiance of rows [first_row, first_row + rows) of photo `photo`: 3·width·rows values, R
  // G B interleaved. Thread-safe. A band shares the geometry of its inner pixel corners.
  void RenderRows(int photo, int first_row, int rows, std::span<float> rgb) const;

 private:
  struct PhotoGeometry {
    Eigen::Matrix3d sample_from_camera;
    Eigen::Vector3d camera_mm;
    View view;
  };
  struct Texel {
    std::array<float, kSvbrdfPlanes> value;
  };
  // What lies at a point of the plane: the sample, or a Lambertian surface by number.
  enum Surface : unsigned char { kSample, kTable, kInk, kPaper };
  using Rgb = std::array<float, 3>;
  // Positions (sample frame, mm) and surfaces at the pixel corners of one image row.
  struct CornerRow {
    std::vector<Eigen::Vector2d> position_mm;
    std::vector<Surface> surface;
  };

  Surface SurfaceAt(const Eigen::Vector2d& position_mm) const;
  double TablePattern(const Eigen::Vector2d& position_mm) const;
  void FillCorners(const PhotoGeometry& geometry, int corner_row, CornerRow* corners) const;
  Rgb ShadeSurface(const PhotoGeometry& geometry, Surface surface,
                   const Eigen::Vector2d& position_mm) const;
  Rgb ShadeSample(const PhotoGeometry& geometry, const Eigen::Vector2d& position_mm) const;
  Rgb ShadePixel(const PhotoGeometry& geometry, const CornerRow& above, const CornerRow& below,
                 int column) const;

  const CapturePlan& plan_;
  BoardPainter painter_;
  std::vector<PhotoGeometry> geometry_;
  int map_width_, map_height_;
  std::vector<Texel> texels_;
  std::vector<Eigen::Vector2f> normalized_;  // (u, v) at pixel corners, (width + 1) × (height + 1)
};

}  // namespace glint
