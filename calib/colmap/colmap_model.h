// COLMAP's sparse models (version 3.8) as values: cameras, images, points; read and written as text
// and binary (https://colmap.github.io/format.html).
//
// The files name no version and no units: lengths are of the model's own. Numbers are kept as they
// are, in the order of the file, so that a round trip text ↔ binary loses nothing. Reading is
// bounded: no count is believed that the file is too short for.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "base/camera/rigid3.h"

namespace glint {

inline constexpr std::uint64_t kNoColmapPoint = std::numeric_limits<std::uint64_t>::max();

struct ColmapCamera {
  std::uint32_t id = 0;
  int model = 0;  // COLMAP's number, 0 … 10; see colmap_camera.h
  std::uint64_t width_px = 0, height_px = 0;
  std::vector<double> parameters;
};

// A feature of an image.
struct ColmapObservation {
  Eigen::Vector2d point_px;  // the centre of the top-left pixel is (0.5, 0.5)
  std::uint64_t point_id = kNoColmapPoint;
};

struct ColmapImage {
  std::uint32_t id = 0;
  std::array<double, 4> quaternion_wxyz{1, 0, 0, 0};  // camera from model
  Eigen::Vector3d translation{0, 0, 0};
  std::uint32_t camera_id = 0;
  std::string name;  // relative to the folder of the images
  std::vector<ColmapObservation> observations;

  Rigid3 camera_from_model() const;
  void set_camera_from_model(const Rigid3& camera_from_model);
};

struct ColmapTrackElement {
  std::uint32_t image_id = 0;
  std::uint32_t observation = 0;  // index into the image's observations
};

struct ColmapPoint {
  std::uint64_t id = 0;
  Eigen::Vector3d position{0, 0, 0};
  std::array<std::uint8_t, 3> rgb{0, 0, 0};
  double error_px = 0;
  std::vector<ColmapTrackElement> track;
};

struct ColmapModel {
  std::vector<ColmapCamera> cameras;
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint> points;

  const ColmapCamera* FindCamera(std::uint32_t id) const;  // nullptr: none
};

enum class ColmapFormat { kText, kBinary };

// Reads `folder`, or its sparse/0, sparse or 0 where the folder itself holds no model; binary files
// where both kinds lie there. `files` returns what was read. Throws UserError: missing, cut-off or
// malformed files; camera models that 3.8 does not have; ids that do not fit together.
ColmapModel ReadColmapModel(const std::filesystem::path& folder,
                            std::vector<std::filesystem::path>* files = nullptr);

// The three files that ReadColmapModel would read. Throws UserError naming what is missing.
std::vector<std::filesystem::path> ColmapModelFiles(const std::filesystem::path& folder);

// Writes cameras, images and points3D (.txt or .bin) into `folder`, which must exist. Throws
// UserError for a name with white space in text, which COLMAP would read wrongly.
void WriteColmapModel(const std::filesystem::path& folder, const ColmapModel& model,
                      ColmapFormat format);

}  // namespace glint
