// COLMAP 3.8's camera models, and their conversion to ours.
//
// Nine are the same here and there (base/camera/camera_model.h). FOV and THIN_PRISM_FISHEYE are
// replaced by a FULL_OPENCV camera that is fitted to a grid of the picture's points.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/camera/camera_model.h"
#include "calib/colmap/colmap_model.h"

namespace glint {

struct ColmapModelInfo {
  std::string_view name;
  size_t parameters = 0;
  size_t focal_lengths = 1;  // the first parameters; the principal point follows
};

// By COLMAP's number of the model.
std::span<const ColmapModelInfo> ColmapModels();
std::optional<int> ColmapModelFromName(std::string_view name);

// Image point of the ray in the direction (u, v, 1), by any of the eleven models.
Eigen::Vector2d ColmapImagePoint(int model, std::span<const double> parameters, double u, double v);

struct ConvertedCamera {
  Camera camera;
  bool exact = true;
  double rms_px = 0, largest_px = 0;  // of the fit, over the picture
};

// A fit farther off than this anywhere in the picture is refused.
inline constexpr double kLargestConversion_px = 0.5;

// `file` is named in errors. Throws UserError for a lens that sees beyond 80° from its axis, and
// for a fit that is off by more than kLargestConversion_px.
ConvertedCamera ConvertCamera(const std::filesystem::path& file, const ColmapCamera& camera);

ColmapCamera ToColmapCamera(const Camera& camera, std::uint32_t id);

}  // namespace glint
