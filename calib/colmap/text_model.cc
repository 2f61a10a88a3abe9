// One record a line (images: two), separated by white space; '#' begins a comment. Numbers are
// written with as few digits as read back the same.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "base/errors/errors.h"
#include "calib/colmap/colmap_camera.h"
#include "calib/colmap/model_io.h"

namespace glint::colmap {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t\r";

class Lines {
 public:
  explicit Lines(const fs::path& file) : file_(file), text_(ReadModelFile(file)) {}

  // The next line, comments and empty ones skipped; nullopt at the end.
  std::optional<std::string_view> NextRecord() {
    while (at_ < text_.size()) {
      const std::string_view line = Next();
      const size_t first = line.find_first_not_of(kBlanks);
      if (first != std::string_view::npos && line[first] != '#') return line.substr(first);
    }
    return std::nullopt;
  }

  // The next line, whatever it is; nullopt at the end.
  std::optional<std::string_view> NextLine() {
    if (at_ >= text_.size()) return std::nullopt;
    return Next();
  }

  const fs::path& file() const { return file_; }
  std::string place() const { return fmt::format("line {}", number_); }

 private:
  std::string_view Next() {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    return line;
  }

  fs::path file_;
  std::string text_;
  size_t at_ = 0;
  int number_ = 0;
};

class Fields {
 public:
  Fields(const Lines& lines, std::string_view line) : lines_(lines), rest_(line) {}

  bool AtEnd() const { return rest_.find_first_not_of(kBlanks) == std::string_view::npos; }

  std::string_view Word(const char* what) {
    const size_t first = rest_.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) Reject(what, "the line's end");
    const size_t end = std::min(rest_.find_first_of(kBlanks, first), rest_.size());
    const std::string_view word = rest_.substr(first, end - first);
    rest_.remove_prefix(end);
    return word;
  }

  template <class T>
  T Number(const char* what) {
    const std::string_view word = Word(what);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      Reject(what, "'" + std::string(word.substr(0, 40)) + "'");
    }
    return value;
  }

  std::string Rest() {
    const size_t first = std::min(rest_.find_first_not_of(kBlanks), rest_.size());
    const size_t last = rest_.find_last_not_of(kBlanks);
    std::string rest(last == std::string_view::npos ? "" : rest_.substr(first, last + 1 - first));
    rest_ = {};
    return rest;
  }

  void RequireEnd() {
    if (!AtEnd()) Reject("end", "'" + std::string(Word("end").substr(0, 40)) + "'");
  }

  [[noreturn]] void Reject(const char* what, const std::string& found) const {
    throw UserError(
        lines_.file(), lines_.place() + ": " + what, found,
        "the file is truncated, or is not a model in COLMAP 3.8's text format; export it "
        "again");
  }

 private:
  const Lines& lines_;
  std::string_view rest_;
};

}  // namespace

std::vector<ColmapCamera> ReadCamerasText(const fs::path& file) {
  Lines lines(file);
  std::vector<ColmapCamera> cameras;
  while (const auto line = lines.NextRecord()) {
    Fields fields(lines, *line);
    ColmapCamera camera;
    camera.id = fields.Number<std::uint32_t>("camera id");
    const std::string name(fields.Word("camera model"));
    const auto model = ColmapModelFromName(name);
    if (!model) RejectCameraModel(file, camera.id, "'" + name.substr(0, 60) + "'");
    camera.model = *model;
    camera.width_px = fields.Number<std::uint64_t>("width");
    camera.height_px = fields.Number<std::uint64_t>("height");
    camera.parameters.resize(ColmapModels()[camera.model].parameters);
    for (double& value : camera.parameters) value = fields.Number<double>("parameter");
    fields.RequireEnd();
    CheckCamera(file, camera);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

std::vector<ColmapImage> ReadImagesText(const fs::path& file) {
  Lines lines(file);
  std::vector<ColmapImage> images;
  while (const auto line = lines.NextRecord()) {
    Fields fields(lines, *line);
    ColmapImage image;
    image.id = fields.Number<std::uint32_t>("image id");
    for (double& q : image.quaternion_wxyz) q = fields.Number<double>("rotation");
    for (int k = 0; k < 3; ++k) image.translation[k] = fields.Number<double>("translation");
    image.camera_id = fields.Number<std::uint32_t>("camera id");
    image.name = fields.Rest();
    const auto second = lines.NextLine();
    if (!second) fields.Reject("features", "the file's end");
    Fields features(lines, *second);
    while (!features.AtEnd()) {
      ColmapObservation observation;
      observation.point_px.x() = features.Number<double>("feature x");
      observation.point_px.y() = features.Number<double>("feature y");
      const auto id = features.Number<std::int64_t>("feature's point id");
      if (id < -1) features.Reject("feature's point id", std::to_string(id));
      observation.point_id = static_cast<std::uint64_t>(id);  // −1 is kNoColmapPoint
      image.observations.push_back(observation);
    }
    CheckImage(file, image);
    images.push_back(std::move(image));
  }
  return images;
}

std::vector<ColmapPoint> ReadPointsText(const fs::path& file) {
  Lines lines(file);
  std::vector<ColmapPoint> points;
  while (const auto line = lines.NextRecord()) {
    Fields fields(lines, *line);
    ColmapPoint point;
    point.id = fields.Number<std::uint64_t>("point id");
    for (int k = 0; k < 3; ++k) point.position[k] = fields.Number<double>("position");
    for (std::uint8_t& value : point.rgb) value = fields.Number<std::uint8_t>("colour");
    point.error_px = fields.Number<double>("error");
    while (!fields.AtEnd()) {
      ColmapTrackElement element;
      element.image_id = fields.Number<std::uint32_t>("track's image id");
      element.observation = fields.Number<std::uint32_t>("track's feature");
      point.track.push_back(element);
    }
    CheckPoint(file, point);
    points.push_back(std::move(point));
  }
  return points;
}

std::string CamerasText(const ColmapModel& model) {
  std::string text = fmt::format(
      "# Camera list with one line of data per camera:\n"
      "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
      "# Number of cameras: {}\n",
      model.cameras.size());
  for (const ColmapCamera& camera : model.cameras) {
    text += fmt::format("{} {} {} {}", camera.id, ColmapModels()[camera.model].name,
                        camera.width_px, camera.height_px);
    for (const double value : camera.parameters) text += fmt::format(" {}", value);
    text += '\n';
  }
  return text;
}

std::string ImagesText(const ColmapModel& model) {
  std::string text = fmt::format(
      "# Image list with two lines of data per image:\n"
      "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
      "# Number of images: {}\n",
      model.images.size());
  for (const ColmapImage& image : model.images) {
    if (image.name.find_first_of(" \t\r\n") != std::string::npos) {
      throw UserError(
          "images.txt: image '" + image.name +
          "': found white space in the name, which COLMAP's text format does not allow; "
          "rename the photograph, or write the model as binary");
    }
    text += std::to_string(image.id);
    for (const double q : image.quaternion_wxyz) text += fmt::format(" {}", q);
    for (int k = 0; k < 3; ++k) text += fmt::format(" {}", image.translation[k]);
    text += fmt::format(" {} {}\n", image.camera_id, image.name);
    const char* gap = "";
    for (const ColmapObservation& observation : image.observations) {
      text += fmt::format("{}{} {} {}", gap, observation.point_px.x(), observation.point_px.y(),
                          static_cast<std::int64_t>(observation.point_id));
      gap = " ";
    }
    text += '\n';
  }
  return text;
}

std::string PointsText(const ColmapModel& model) {
  std::string text = fmt::format(
      "# 3D point list with one line of data per point:\n"
      "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n"
      "# Number of points: {}\n",
      model.points.size());
  for (const ColmapPoint& point : model.points) {
    text += std::to_string(point.id);
    for (int k = 0; k < 3; ++k) text += fmt::format(" {}", point.position[k]);
    text += fmt::format(" {} {} {} {}", point.rgb[0], point.rgb[1], point.rgb[2], point.error_px);
    for (const ColmapTrackElement& element : point.track) {
      text += fmt::format(" {} {}", element.image_id, element.observation);
    }
    text += '\n';
  }
  return text;
}

}  // namespace glint::colmap
