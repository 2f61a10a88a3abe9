// Where highlights fall on a sample, from the geometry of camera and flash alone.
//
// A flat texel shows its highlight where the half vector of the directions to light and camera is
// its normal. A lobe of roughness r (α = r²) has half of its peak at the angle θ from there with
// sin²θ = (√2 − 1) α² / (1 − α²) (GGX's D, docs/conventions.md): 3.3° for r = 0.3, 6° for 0.4, 9.6°
// for 0.5. A photograph whose half vector stays farther away tells of the diffuse colour and little
// of gloss.
#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"

namespace glint {

inline constexpr double kDegree = std::numbers::pi / 180;

// A camera whose pose on the sample is known.
struct PosedCamera {
  Camera camera;
  Rigid3 camera_from_sample;
};

struct GuidancePhoto {
  std::string name;
  Eigen::Vector3d camera_in_sample_mm{0, 0, 0}, light_in_sample_mm{0, 0, 0};
  // Says what lies inside of the picture and how large a texel is in it; without it (rectified
  // sets) the whole sample counts as inside.
  std::optional<PosedCamera> posed;
  double clipped_share = 0;  // of the sample's pixels
  double blur_px = 0;        // standard deviation of the edges' blur; 0: not known
};

// The sample cut into cells; row 0 is at +y, as in a map.
struct CoverageGrid {
  int columns = 0, rows = 0;
  double width_mm = 0, height_mm = 0;

  size_t cells() const { return static_cast<size_t>(columns) * rows; }
  Eigen::Vector2d Centre_mm(size_t cell) const;
};

// About square cells, `most` along the longer side.
CoverageGrid MakeCoverageGrid(const std::array<double, 2>& sample_size_mm, int most = 32);

struct Coverage {
  CoverageGrid grid;
  std::vector<int> photos;                   // that show the cell
  std::vector<double> least_half_angle_deg;  // over these; infinity: none does

  double ShownShare() const;
  double HighlightShare(double highlight_deg) const;  // of all cells
};

Coverage ComputeCoverage(const CoverageGrid& grid, const std::vector<GuidancePhoto>& photos);

// Between the sample's normal and the half vector at a point of the sample; 180 when camera or
// light is at or below the plane.
double HalfAngle_deg(const Eigen::Vector3d& camera_mm, const Eigen::Vector3d& light_mm,
                     const Eigen::Vector2d& point_mm);

bool ShowsPoint(const GuidancePhoto& photo, const Eigen::Vector2d& point_mm);
double ShownShare(const GuidancePhoto& photo, const CoverageGrid& grid);

// Geometric mean over directions of the sample's plane, at its centre; 0: unknown.
double PixelsPerMm(const GuidancePhoto& photo);

// Direction from the sample's centre: tilt from the normal, azimuth in [0, 360) from +x (right)
// over +y (top).
struct Direction {
  double tilt_deg = 0, azimuth_deg = 0;
};
Direction DirectionOf(const Eigen::Vector3d& point_in_sample_mm);

}  // namespace glint
