// The parts of reading and writing models that one file each holds.
#pragma once

#include <filesystem>
#include <string>

#include "calib/colmap/colmap_model.h"

namespace glint::colmap {

inline constexpr std::uint64_t kLargestFile_bytes = 1ull << 31;
inline constexpr std::size_t kLongestName = 4096;

std::string ReadModelFile(const std::filesystem::path& file);

std::vector<ColmapCamera> ReadCamerasText(const std::filesystem::path& file);
std::vector<ColmapImage> ReadImagesText(const std::filesystem::path& file);
std::vector<ColmapPoint> ReadPointsText(const std::filesystem::path& file);
std::vector<ColmapCamera> ReadCamerasBinary(const std::filesystem::path& file);
std::vector<ColmapImage> ReadImagesBinary(const std::filesystem::path& file);
std::vector<ColmapPoint> ReadPointsBinary(const std::filesystem::path& file);

std::string CamerasText(const ColmapModel& model);
std::string ImagesText(const ColmapModel& model);
std::string PointsText(const ColmapModel& model);
std::string CamerasBinary(const ColmapModel& model);
std::string ImagesBinary(const ColmapModel& model);
std::string PointsBinary(const ColmapModel& model);

// Throws UserError naming the file and the camera ("camera 3").
void CheckCamera(const std::filesystem::path& file, const ColmapCamera& camera);
[[noreturn]] void RejectCameraModel(const std::filesystem::path& file, std::uint32_t camera,
                                    const std::string& found);
void CheckImage(const std::filesystem::path& file, const ColmapImage& image);
void CheckPoint(const std::filesystem::path& file, const ColmapPoint& point);
// Ids that are twice there, or that point nowhere. `files`: cameras, images, points.
void CheckModel(const std::vector<std::filesystem::path>& files, const ColmapModel& model);

}  // namespace glint::colmap
