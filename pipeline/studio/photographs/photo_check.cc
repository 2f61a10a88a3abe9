#include "pipeline/studio/photographs/photo_check.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/formats/board_file.h"
#include "calib/capture/camera_groups.h"
#include "calib/capture/reduced_photo.h"
#include "calib/corners/detector.h"
#include "calib/guidance/clipping.h"
#include "pipeline/studio/photographs/thumbnail.h"

namespace glint {
namespace {

// Raised whenever the same photograph may be judged otherwise, so that older results are not used.
constexpr int kCheckVersion = 1;
constexpr double kUsualFocal_mm = 26;  // 35 mm equivalent, see capture/assumed_camera.h

// A pinhole camera with the principal point in the middle.
Camera PinholeOf(const Photo& photo, int width_px, int height_px) {
  const double focal_mm = photo.focal_length_35mm > 0 ? photo.focal_length_35mm : kUsualFocal_mm;
  const double focal_px = focal_mm / kFilmDiagonal_mm * std::hypot(width_px, height_px);
  return {CameraModel::kSimplePinhole,
          width_px,
          height_px,
          {focal_px, 0.5 * width_px, 0.5 * height_px}};
}

Rigid3 RigidOf(const cv::Vec3d& turn, const cv::Vec3d& shift) {
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Rigid3 rigid;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) rigid.rotation(r, c) = rotation(r, c);
    rigid.translation[r] = shift[r];
  }
  return rigid;
}

std::optional<Rigid3> PoseFrom(const std::vector<CornerObservation>& corners,
                               const Camera& camera) {
  constexpr size_t kLeastCorners = 6;
  if (corners.size() < kLeastCorners) return std::nullopt;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const CornerObservation& corner : corners) {
    points.emplace_back(corner.position_in_sample_mm.x(), corner.position_in_sample_mm.y(), 0);
    pixels.emplace_back(corner.point_px.x(), corner.point_px.y());
  }
  const double f = camera.parameters[0];
  const cv::Matx33d intrinsics(f, 0, camera.parameters[1], 0, f, camera.parameters[2], 0, 0, 1);
  cv::Vec3d turn, shift;
  try {
    if (!cv::solvePnP(points, pixels, intrinsics, cv::noArray(), turn, shift, false,
                      cv::SOLVEPNP_IPPE)) {
      return std::nullopt;
    }
    cv::solvePnPRefineLM(points, pixels, intrinsics, cv::noArray(), turn, shift);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return RigidOf(turn, shift);
}

std::optional<GuidancePhoto> PoseOf(const Photo& photo, const CheckTask& task,
                                    const BoardDetection& detection) {
  if (!detection.position_known) return std::nullopt;
  const Camera camera = PinholeOf(photo, photo.image.width, photo.image.height);
  const auto camera_from_sample = PoseFrom(detection.corners, camera);
  if (!camera_from_sample) return std::nullopt;
  const Rigid3 sample_from_camera = Inverse(*camera_from_sample);
  GuidancePhoto pose;
  pose.camera_in_sample_mm = sample_from_camera.translation;
  pose.light_in_sample_mm =
      sample_from_camera *
      Eigen::Vector3d(task.light_offset_mm[0], task.light_offset_mm[1], task.light_offset_mm[2]);
  pose.posed = PosedCamera{camera, *camera_from_sample};
  return pose;
}

// From the reduced copy to the photograph itself.
void EnlargeMeasures(int reduction, const std::filesystem::path& file, PhotoCheck* check) {
  if (reduction == 1) return;
  const auto [width_px, height_px] = PhotoSize(file);
  check->measures.file.image.width = width_px;
  check->measures.file.image.height = height_px;
  check->measures.blur_px *= reduction;
  check->measures.edge_px *= reduction;
  if (!check->pose) return;
  Camera& camera = check->pose->posed->camera;
  camera = ScaledCamera(camera, reduction);
  camera.width_px = width_px;
  camera.height_px = height_px;
}

std::string HexOf(const std::vector<unsigned char>& bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::vector<unsigned char> BytesOfHex(const std::string& text) {
  std::vector<unsigned char> bytes;
  for (size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<unsigned char>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

template <class Vector>
Json ListOf(const Vector& values) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) list.push_back(values(i));
  return list;
}

template <class Vector>
void FillFrom(const Json& list, Vector* values) {
  for (Eigen::Index i = 0; i < values->size(); ++i) {
    (*values)(i) = list.at(static_cast<size_t>(i)).template get<double>();
  }
}

Json PoseJson(const GuidancePhoto& pose) {
  const Rigid3& rigid = pose.posed->camera_from_sample;
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> rotation(rigid.rotation.data());
  return {{"camera_mm", ListOf(pose.camera_in_sample_mm)},
          {"light_mm", ListOf(pose.light_in_sample_mm)},
          {"size_px", {pose.posed->camera.width_px, pose.posed->camera.height_px}},
          {"intrinsics_px", pose.posed->camera.parameters},
          {"rotation", ListOf(rotation)},
          {"translation_mm", ListOf(rigid.translation)}};
}

GuidancePhoto PoseFromJson(const Json& json) {
  GuidancePhoto pose;
  FillFrom(json.at("camera_mm"), &pose.camera_in_sample_mm);
  FillFrom(json.at("light_mm"), &pose.light_in_sample_mm);
  PosedCamera posed;
  posed.camera = {CameraModel::kSimplePinhole, json.at("size_px").at(0).get<int>(),
                  json.at("size_px").at(1).get<int>(),
                  json.at("intrinsics_px").get<std::vector<double>>()};
  Eigen::Map<Eigen::Matrix<double, 9, 1>> rotation(posed.camera_from_sample.rotation.data());
  FillFrom(json.at("rotation"), &rotation);
  FillFrom(json.at("translation_mm"), &posed.camera_from_sample.translation);
  pose.posed = posed;
  return pose;
}

}  // namespace

std::string CheckTask::Key() const {
  Json json = {{"version", kCheckVersion},
               {"sample_mm", sample_size_mm},
               {"light_mm", light_offset_mm},
               {"board", nullptr}};
  if (board) {
    json["board"] = ToJson(BoardFile{*board, std::nullopt});
    json["centre_mm"] = {board->board_centre_in_sample_mm.x(),
                         board->board_centre_in_sample_mm.y()};
  }
  return HashBytes(json.dump());
}

CheckTask CheckTaskOf(const Capture& capture) {
  CheckTask task;
  if (capture.has_board && !capture.fixed_camera()) task.board = capture.board;
  task.sample_size_mm = capture.sample_size_mm;
  task.light_offset_mm = capture.light_offset_mm;
  return task;
}

PhotoCheck CheckPhoto(const std::filesystem::path& file, const CheckTask& task,
                      std::string* thumbnail_jpeg) {
  PhotoCheck check;
  thumbnail_jpeg->clear();
  try {
    int reduction = 1;
    const Photo photo = ReadReducedPhoto(file, kCheck_px, &reduction);
    *thumbnail_jpeg = SmallJpeg(photo.image);
    const GrayImage gray = GrayFromPhoto(photo);
    BoardDetection detection;
    if (task.board) {
      detection = DetectBoard(gray, *task.board);
      check.board_found = !detection.corners.empty();
      check.board_problem = detection.problem;
      check.mismatch = detection.mismatch;
      check.clipped_share = ClippedShareOfSample(photo, detection.corners, task.sample_size_mm);
      check.pose = PoseOf(photo, task, detection);
      if (check.pose) check.pose->clipped_share = check.clipped_share;
    }
    check.measures = MeasurePhoto("", photo, gray, detection);
    EnlargeMeasures(reduction, file, &check);
  } catch (const std::exception& error) {
    check.unreadable = error.what();
  }
  return check;
}

Json ToJson(const PhotoCheck& check) {
  const PhotoMeasures& m = check.measures;
  const Photo& f = m.file;
  Json json = {{"unreadable", check.unreadable},
               {"board_found", check.board_found},
               {"board_problem", check.board_problem},
               {"mismatch", check.mismatch},
               {"clipped_share", check.clipped_share},
               {"measures",
                {{"size_px", {f.image.width, f.image.height}},
                 {"format", f.format},
                 {"bits", f.bits},
                 {"camera", f.camera_model},
                 {"focal_length_35mm", f.focal_length_35mm},
                 {"exposure_time_s", f.exposure_time_s},
                 {"iso", f.iso},
                 {"f_number", f.f_number},
                 {"flash", f.exif.flash},
                 {"corners", m.corners},
                 {"blur_px", m.blur_px},
                 {"edge_px", m.edge_px},
                 {"clipped", m.clipped},
                 {"white", m.white},
                 {"thumbnail", HexOf(m.thumbnail)}}},
               {"pose", nullptr}};
  if (check.pose) json["pose"] = PoseJson(*check.pose);
  return json;
}

std::optional<PhotoCheck> PhotoCheckFromJson(const Json& json) {
  try {
    PhotoCheck check;
    check.unreadable = json.at("unreadable").get<std::string>();
    check.board_found = json.at("board_found").get<bool>();
    check.board_problem = json.at("board_problem").get<std::string>();
    check.mismatch = json.at("mismatch").get<bool>();
    check.clipped_share = json.at("clipped_share").get<double>();
    const Json& from = json.at("measures");
    PhotoMeasures& m = check.measures;
    m.file.image.width = from.at("size_px").at(0).get<int>();
    m.file.image.height = from.at("size_px").at(1).get<int>();
    m.file.format = from.at("format").get<std::string>();
    m.file.bits = from.at("bits").get<int>();
    m.file.camera_model = from.at("camera").get<std::string>();
    m.file.focal_length_35mm = from.at("focal_length_35mm").get<double>();
    m.file.exposure_time_s = from.at("exposure_time_s").get<double>();
    m.file.iso = from.at("iso").get<double>();
    m.file.f_number = from.at("f_number").get<double>();
    m.file.exif.flash = from.at("flash").get<int>();
    m.corners = from.at("corners").get<int>();
    m.blur_px = from.at("blur_px").get<double>();
    m.edge_px = from.at("edge_px").get<double>();
    m.clipped = from.at("clipped").get<double>();
    m.white = from.at("white").get<double>();
    m.thumbnail = BytesOfHex(from.at("thumbnail").get<std::string>());
    if (!json.at("pose").is_null()) {
      check.pose = PoseFromJson(json.at("pose"));
      check.pose->clipped_share = check.clipped_share;
    }
    return check;
  } catch (const std::exception&) {  // of another version, or torn
    return std::nullopt;
  }
}

}  // namespace glint
