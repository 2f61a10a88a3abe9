#include "calib/colmap/colmap_model.h"

#include <algorithm>
#include <fstream>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "calib/colmap/model_io.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr const char* kParts[] = {"cameras", "images", "points3D"};

bool HasAny(const fs::path& folder, const std::string& extension) {
  return std::any_of(std::begin(kParts), std::end(kParts),
                     [&](const char* part) { return fs::exists(folder / (part + extension)); });
}

bool HasAll(const fs::path& folder, const std::string& extension) {
  return std::all_of(std::begin(kParts), std::end(kParts), [&](const char* part) {
    return fs::is_regular_file(folder / (part + extension));
  });
}

// Where the model lies: COLMAP's own projects put it into sparse/0.
fs::path ModelFolder(const fs::path& folder) {
  for (const char* inside : {"", "sparse/0", "sparse", "0"}) {
    const fs::path candidate = *inside == 0 ? folder : folder / inside;
    if (HasAny(candidate, ".bin") || HasAny(candidate, ".txt")) return candidate;
  }
  return folder;
}

}  // namespace

Rigid3 ColmapImage::camera_from_model() const {
  const auto& q = quaternion_wxyz;
  return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix(), translation};
}

void ColmapImage::set_camera_from_model(const Rigid3& camera_from_model) {
  Eigen::Quaterniond q(camera_from_model.rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()};
  translation = camera_from_model.translation;
}

const ColmapCamera* ColmapModel::FindCamera(std::uint32_t id) const {
  for (const ColmapCamera& camera : cameras) {
    if (camera.id == id) return &camera;
  }
  return nullptr;
}

std::vector<fs::path> ColmapModelFiles(const fs::path& folder) {
  const std::string remedy =
      "give the folder of a COLMAP model: cameras, images and points3D, all .bin or all .txt "
      "(COLMAP: File, Export model)";
  if (!fs::is_directory(folder)) throw UserError(folder, "", "no such folder", remedy);
  const fs::path where = ModelFolder(folder);
  std::string extension = HasAll(where, ".bin") ? ".bin" : HasAll(where, ".txt") ? ".txt" : "";
  if (extension.empty()) extension = HasAny(where, ".bin") ? ".bin" : ".txt";
  std::vector<fs::path> files;
  for (const char* part : kParts) {
    files.push_back(where / (part + extension));
    if (!fs::is_regular_file(files.back())) {
      throw UserError(files.back(), "", "no such file", remedy);
    }
  }
  return files;
}

ColmapModel ReadColmapModel(const fs::path& folder, std::vector<fs::path>* files) {
  const std::vector<fs::path> found = ColmapModelFiles(folder);
  const bool binary = found[0].extension() == ".bin";
  ColmapModel model;
  model.cameras = binary ? colmap::ReadCamerasBinary(found[0]) : colmap::ReadCamerasText(found[0]);
  model.images = binary ? colmap::ReadImagesBinary(found[1]) : colmap::ReadImagesText(found[1]);
  model.points = binary ? colmap::ReadPointsBinary(found[2]) : colmap::ReadPointsText(found[2]);
  colmap::CheckModel(found, model);
  if (files != nullptr) *files = found;
  return model;
}

void WriteColmapModel(const fs::path& folder, const ColmapModel& model, ColmapFormat format) {
  const bool binary = format == ColmapFormat::kBinary;
  const std::string extension = binary ? ".bin" : ".txt";
  WriteFileAtomically(folder / ("cameras" + extension),
                      binary ? colmap::CamerasBinary(model) : colmap::CamerasText(model));
  WriteFileAtomically(folder / ("images" + extension),
                      binary ? colmap::ImagesBinary(model) : colmap::ImagesText(model));
  WriteFileAtomically(folder / ("points3D" + extension),
                      binary ? colmap::PointsBinary(model) : colmap::PointsText(model));
}

namespace colmap {

std::string ReadModelFile(const fs::path& file) {
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(file, error);
  if (error) throw UserError(file, "", "a file that cannot be read", "check its permissions");
  if (bytes > kLargestFile_bytes) {
    throw UserError(
        file, "", std::to_string(bytes) + " bytes",
        "only models with files of up to 2 GiB are read; make one from the capture's photographs "
        "alone");
  }
  std::string text(bytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(bytes));
  if (static_cast<std::uint64_t>(stream.gcount()) != bytes) {
    throw UserError(file, "", "a file that cannot be read to its end", "copy it again");
  }
  return text;
}

}  // namespace colmap
}  // namespace glint
