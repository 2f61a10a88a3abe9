// Little-endian records without padding, after a count of 64 bits. Every machine that Glint is
// built for stores numbers this way.
#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <type_traits>

#include "base/errors/errors.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/model_io.h"

namespace glint::colmap {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

// Sizes of the records without the lists that they end with.
constexpr std::uint64_t kCamera_bytes = 24, kImage_bytes = 73, kPoint_bytes = 51;
constexpr std::uint64_t kObservation_bytes = 24, kTrack_bytes = 8;

class Reader {
 public:
  explicit Reader(const fs::path& file) : file_(file), bytes_(ReadModelFile(file)) {}

  // What is being read, for messages.
  void set_field(std::string field) { field_ = std::move(field); }

  template <class T>
  T Take() {
    static_assert(std::is_arithmetic_v<T>);
    if (bytes_.size() - at_ < sizeof(T)) CutOff();
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  // A count of records that take `record_bytes` or more each: never more than the file holds.
  std::uint64_t TakeCount(std::uint64_t record_bytes) {
    const auto count = Take<std::uint64_t>();
    if (count > (bytes_.size() - at_) / record_bytes) CutOff();
    return count;
  }

  std::string TakeName() {
    const size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) CutOff();
    std::string name = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return name;
  }

  void RequireEnd() const {
    if (at_ == bytes_.size()) return;
    throw UserError(file_, "", fmt::format("{} bytes after the last record", bytes_.size() - at_),
                    "the file is damaged, or was not written by COLMAP 3.8; export the "
                    "model again as text");
  }

  const fs::path& file() const { return file_; }

 private:
  [[noreturn]] void CutOff() const {
    throw UserError(file_, field_, fmt::format("the file's end at byte {}", bytes_.size()),
                    "the file is truncated, or is not a COLMAP model; copy or export it again");
  }

  fs::path file_;
  std::string bytes_;
  size_t at_ = 0;
  std::string field_ = "count";
};

class Writer {
 public:
  template <class T>
  void Put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }
  void PutName(const std::string& name) { bytes_.append(name.c_str(), name.size() + 1); }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

std::vector<ColmapCamera> ReadCamerasBinary(const fs::path& file) {
  Reader reader(file);
  std::vector<ColmapCamera> cameras(reader.TakeCount(kCamera_bytes));
  for (size_t i = 0; i < cameras.size(); ++i) {
    reader.set_field(fmt::format("camera {} of {}", i + 1, cameras.size()));
    ColmapCamera& camera = cameras[i];
    camera.id = reader.Take<std::uint32_t>();
    camera.model = reader.Take<std::int32_t>();
    if (camera.model < 0 || camera.model >= static_cast<int>(ColmapModels().size())) {
      RejectCameraModel(file, camera.id, "number " + std::to_string(camera.model));
    }
    camera.width_px = reader.Take<std::uint64_t>();
    camera.height_px = reader.Take<std::uint64_t>();
    camera.parameters.resize(ColmapModels()[camera.model].parameters);
    for (double& value : camera.parameters) value = reader.Take<double>();
    CheckCamera(file, camera);
  }
  reader.RequireEnd();
  return cameras;
}

std::vector<ColmapImage> ReadImagesBinary(const fs::path& file) {
  Reader reader(file);
  std::vector<ColmapImage> images(reader.TakeCount(kImage_bytes));
  for (size_t i = 0; i < images.size(); ++i) {
    reader.set_field(fmt::format("image {} of {}", i + 1, images.size()));
    ColmapImage& image = images[i];
    image.id = reader.Take<std::uint32_t>();
    for (double& q : image.quaternion_wxyz) q = reader.Take<double>();
    for (int k = 0; k < 3; ++k) image.translation[k] = reader.Take<double>();
    image.camera_id = reader.Take<std::uint32_t>();
    image.name = reader.TakeName();
    image.observations.resize(reader.TakeCount(kObservation_bytes));
    for (ColmapObservation& observation : image.observations) {
      observation.point_px.x() = reader.Take<double>();
      observation.point_px.y() = reader.Take<double>();
      observation.point_id = reader.Take<std::uint64_t>();
    }
    CheckImage(file, image);
  }
  reader.RequireEnd();
  return images;
}

std::vector<ColmapPoint> ReadPointsBinary(const fs::path& file) {
  Reader reader(file);
  std::vector<ColmapPoint> points(reader.TakeCount(kPoint_bytes));
  for (size_t i = 0; i < points.size(); ++i) {
    reader.set_field(fmt::format("point {} of {}", i + 1, points.size()));
    ColmapPoint& point = points[i];
    point.id = reader.Take<std::uint64_t>();
    for (int k = 0; k < 3; ++k) point.position[k] = reader.Take<double>();
    for (std::uint8_t& value : point.rgb) value = reader.Take<std::uint8_t>();
    point.error_px = reader.Take<double>();
    point.track.resize(reader.TakeCount(kTrack_bytes));
    for (ColmapTrackElement& element : point.track) {
      element.image_id = reader.Take<std::uint32_t>();
      element.observation = reader.Take<std::uint32_t>();
    }
    CheckPoint(file, point);
  }
  reader.RequireEnd();
  return points;
}

std::string CamerasBinary(const ColmapModel& model) {
  Writer writer;
  writer.Put<std::uint64_t>(model.cameras.size());
  for (const ColmapCamera& camera : model.cameras) {
    writer.Put<std::uint32_t>(camera.id);
    writer.Put<std::int32_t>(camera.model);
    writer.Put<std::uint64_t>(camera.width_px);
    writer.Put<std::uint64_t>(camera.height_px);
    for (const double value : camera.parameters) writer.Put(value);
  }
  return writer.Take();
}

std::string ImagesBinary(const ColmapModel& model) {
  Writer writer;
  writer.Put<std::uint64_t>(model.images.size());
  for (const ColmapImage& image : model.images) {
    writer.Put<std::uint32_t>(image.id);
    for (const double q : image.quaternion_wxyz) writer.Put(q);
    for (int k = 0; k < 3; ++k) writer.Put<double>(image.translation[k]);
    writer.Put<std::uint32_t>(image.camera_id);
    writer.PutName(image.name);
    writer.Put<std::uint64_t>(image.observations.size());
    for (const ColmapObservation& observation : image.observations) {
      writer.Put<double>(observation.point_px.x());
      writer.Put<double>(observation.point_px.y());
      writer.Put<std::uint64_t>(observation.point_id);
    }
  }
  return writer.Take();
}

std::string PointsBinary(const ColmapModel& model) {
  Writer writer;
  writer.Put<std::uint64_t>(model.points.size());
  for (const ColmapPoint& point : model.points) {
    writer.Put<std::uint64_t>(point.id);
    for (int k = 0; k < 3; ++k) writer.Put<double>(point.position[k]);
    for (const std::uint8_t value : point.rgb) writer.Put(value);
    writer.Put<double>(point.error_px);
    writer.Put<std::uint64_t>(point.track.size());
    for (const ColmapTrackElement& element : point.track) {
      writer.Put<std::uint32_t>(element.image_id);
      writer.Put<std::uint32_t>(element.observation);
    }
  }
  return writer.Take();
}

}  // namespace glint::colmap
