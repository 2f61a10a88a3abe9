// Pictures of a painted board under a known camera, for the tests of calib.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "base/board/board.h"
#include "base/camera/camera_model.h"
#include "base/camera/rigid3.h"
#include "calib/corners/gray_image.h"

namespace glint::testing {

struct PhotoSettings {
  double margin_mm = 10;
  int samples = 4;        // a side, per pixel
  double blur_px = 0.7;   // of the lens, Gaussian
  double noise = 2.0;     // standard deviation, 8-bit levels
  double vignette = 0.3;  // light falls off by this share toward the corners
  double ink = 0.04, paper = 0.8, table = 0.25, peak = 0.9;
  std::uint64_t seed = 1;
  // Reflectance of what lies on the board; nullopt where nothing does.
  std::function<std::optional<double>(double x_mm, double y_mm)> cover;
};

// Gamma 2.2, 8 bits. The scene's radiance is averaged over each pixel before it is encoded.
GrayImage Photograph(const Board& board, const Camera& camera, const Rigid3& camera_from_sample,
                     const PhotoSettings& settings = {});

// A ChArUco board of 8 × 6 squares of 20 mm, and a camera of 640 × 480 that sees it whole from some
// 240 mm: enough of a capture for programs' tests.
Board SmallBoard();
Camera SmallCamera();

// A grey picture in three channels, on [0, 1].
Image RgbOf(const GrayImage& gray);

// The same as a PNG file; missing folders are made.
void WritePhoto(const std::filesystem::path& file, const GrayImage& gray);

// A camera above the sample that looks at `target_mm`: tilted by `tilt_deg` toward direction
// `azimuth_deg`, rolled by `roll_deg`, `distance_mm` away.
Rigid3 LookAt(double distance_mm, double tilt_deg, double azimuth_deg, double roll_deg,
              Eigen::Vector2d target_mm = {0, 0});

// Image point of a point on the sample's plane.
Eigen::Vector2d Project(const Camera& camera, const Rigid3& camera_from_sample,
                        const Eigen::Vector2d& point_mm);

// Deterministic and equal everywhere, unlike <random>'s distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) {}
  double Uniform(double low, double high);
  double Normal();

 private:
  std::uint64_t Next();
  std::uint64_t state_;
};

}  // namespace glint::testing
