// A synthetic phone capture before it is rendered: board, lens, poses, flash, exposure. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/board/board.h"
#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"
#include "datasets/synth/frame_board.h"

namespace glint {

// From the point that a camera looks at: tilt from the normal, azimuth from +x (right) over +y
// (top).
struct CameraDirection {
  double tilt_deg = 0, azimuth_deg = 0;
};

struct CapturePlanOptions {
  std::uint64_t seed = 0;
  int photos = 12;
  double megapixels = 12;              // 4:3; the focal length follows, so the field of view stays
  double sample_mm = kUsualSample_mm;  // side of the square sample
  double nearest_mm = 270;       // distance of the camera from the point it looks at, uniform in
  double farthest_mm = 330;      // [nearest, farthest]
  double largest_tilt_deg = 40;  // of the views after the first
  // Where each photo is taken from; empty: drawn, from all sides.
  std::vector<CameraDirection> directions;
  bool has_board = true;  // false: a patterned table round the sample instead, for COLMAP
  std::array<double, 3> flash_offset_mm{10, 0,
                                        0};   // in the camera frame: x right, y down, z forward
  std::array<double, 3> flash_tint{1, 1, 1};  // colour of the flash, largest channel 1
  double ambient = 0;         // room's irradiance relative to the flash's in the first photo
  double paper_level = 0.78;  // brightest paper of the capture, relative to clipping
  double vignetting = 0;      // share of the light that the picture's corners lose
  double exposure_ev = 0;     // exposures spread evenly over ± this, in random order
  double exif_error = 0;      // standard deviation of the exposures in EXIF, relative

  // Any board, with the sample at its centre; nullopt: FrameBoard.
  std::optional<Board> board;
};

// Reflectance factors of what surrounds the sample, Lambertian.
inline constexpr double kPaperAlbedo = 0.85;
inline constexpr double kInkAlbedo = 0.05;
inline constexpr std::array<double, 3> kTableAlbedo{0.22, 0.17, 0.13};

struct PlannedPhoto {
  Rigid3 camera_from_sample;
  Eigen::Vector3d light_in_sample_mm;
  double exposure = 1;       // relative to the first photo's
  double exif_exposure = 1;  // what EXIF says of it
};

struct CapturePlan {
  CapturePlanOptions options;
  Board board;           // a frame: the sample lies in its window (without one: what would be seen)
  double margin_mm = 0;  // paper round the squares
  Camera camera;         // RADIAL, one for all photos
  std::vector<PlannedPhoto> photos;
  Eigen::Vector3d light_rgb{1, 1, 1};    // power, radiance·mm² where the sensor clips at 1
  Eigen::Vector3d ambient_rgb{0, 0, 0};  // irradiance
};

// Share of the light that the lens passes at a pixel: (1 + t·r²)⁻², the cosine-to-the-fourth law
// with a strength t of its own; r as in VignettingRadius2. Of purpose not the polynomial that calib
// fits; the camera's `vignetting` is that polynomial's nearest.
double LensFalloff(const CapturePlan& plan, const Eigen::Vector2d& point_px);

// Throws UserError for options that cannot give a capture (too few photos, a camera inside the
// board…).
CapturePlan PlanCapture(const CapturePlanOptions& options);

// The field of view's intrinsics at an image size; lens and principal point vary with the seed.
Camera PhoneCamera(double megapixels, std::uint64_t seed);

}  // namespace glint
