// The AprilTag frame of ../shared/data/captures/bath-tile: photographs that are rectified already,
// so that the cameras' poses have left their geometry. What can be checked: every marker is found
// where the frame's description has it, and the fall-off of the flash on its paper tells where
// camera and flash were.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "calib/corners/detector.h"
#include "calib/light/paper.h"
#include "pipeline/contract/board_file.h"
#include "pipeline/contract/files.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kFrame_mm = 152;  // 97.28 mm are 1024 of its 1600 pixels
constexpr int kPad_px = 40;

fs::path Folder() {
  const char* data = std::getenv("GLINT_DATA");
  return (data != nullptr ? fs::path(data) : fs::path(GLINT_SOURCE_DIR) / "../shared/data") /
         "captures/bath-tile";
}

// The frame ends where the picture does: white round it, as on the paper.
Photo Padded(const Photo& photo) {
  Photo padded = photo;
  const int width = photo.image.width, height = photo.image.height;
  padded.image = Image(width + 2 * kPad_px, height + 2 * kPad_px, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) {
    auto to = padded.image.channel(c);
    const auto from = photo.image.channel(c);
    std::fill(to.begin(), to.end(), 0.7f);
    for (int y = 0; y < height; ++y) {
      std::copy(
          from.begin() + static_cast<std::ptrdiff_t>(y) * width,
          from.begin() + static_cast<std::ptrdiff_t>(y + 1) * width,
          to.begin() + static_cast<std::ptrdiff_t>(y + kPad_px) * padded.image.width + kPad_px);
    }
  }
  return padded;
}

Board Frame() {
  Board board = ReadBoardFile(fs::path(GLINT_SOURCE_DIR) / "docs/boards/materialgan.json").board;
  ScaleBoard(kFrame_mm / board.ruler->length_mm(), &board);
  return board;
}

// Where a point light stands whose light on paper falls off as seen: L = P·z/d³, in logarithms, by
// Gauss-Newton over its place and power.
Eigen::Vector3d LightByFallOff(const std::vector<PaperSample>& samples) {
  Eigen::Vector4d p(0, 0, 100, 0);
  for (int step = 0; step < 100; ++step) {
    Eigen::Matrix4d a = 1e-9 * Eigen::Matrix4d::Identity();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    double level = 0;
    const auto model = [&](const PaperSample& sample) {
      const Eigen::Vector3d way =
          p.head<3>() -
          Eigen::Vector3d(sample.position_in_sample_mm.x(), sample.position_in_sample_mm.y(), 0);
      return std::pair{std::log(way.z()) - 3 * std::log(way.norm()), way};
    };
    for (const PaperSample& s : samples) level += std::log(s.radiance.mean()) - model(s).first;
    p[3] = level / static_cast<double>(samples.size());
    for (const PaperSample& s : samples) {
      const auto [value, way] = model(s);
      Eigen::Vector4d g;
      g << -3 * way / way.squaredNorm(), 1;
      g[2] += 1 / way.z();
      a += g * g.transpose();
      b += g * (std::log(s.radiance.mean()) - p[3] - value);
    }
    const Eigen::Vector4d delta = a.ldlt().solve(b);
    p += delta * std::min(1.0, 20 / delta.head<3>().norm());
    p[2] = std::max(p[2], 10.0);
    if (delta.head<3>().norm() < 1e-4) break;
  }
  return p.head<3>();
}

TEST(BathTile, MarkersLieWhereTheDescriptionHasThemAndTheirPaperTellsTheCamera) {
  if (!fs::exists(Folder())) GTEST_SKIP() << "no real data";
  const Json published = Json::parse(ReadTextFile(Folder() / "parameters.json"));
  const Board board = Frame();
  for (int i = 0; i < 4; ++i) {
    const Photo photo = Padded(ReadPhoto(Folder() / fmt::format("full1600_{:02}.png", i)));
    const auto detection = DetectBoard(GrayFromPhoto(photo), board);
    EXPECT_GE(detection.markers, 14) << detection.problem;
    std::vector<Eigen::Vector2d> errors;
    Eigen::Vector2d mean(0, 0);
    for (const CornerObservation& corner : detection.corners) {
      const Eigen::Vector2d at = corner.position_in_sample_mm;
      if (at.cwiseAbs().maxCoeff() > 0.499 * kFrame_mm) continue;  // on the picture's edge
      const Eigen::Vector2d there(kPad_px + 1600 * (at.x() / kFrame_mm + 0.5),
                                  kPad_px + 1600 * (0.5 - at.y() / kFrame_mm));
      errors.push_back(corner.point_px - there);
      mean += errors.back();
    }
    ASSERT_GE(errors.size(), 12u) << i;
    mean /= static_cast<double>(errors.size());
    double squares = 0;
    for (const Eigen::Vector2d& error : errors) squares += (error - mean).squaredNorm();
    const double rms = std::sqrt(squares / static_cast<double>(errors.size()));
    const auto samples =
        SamplePaper(photo, EncodingFromName("gamma2.2").value(), board, detection.corners);
    const Eigen::Vector3d light = LightByFallOff(samples);
    const Json& camera = published["camera_pos"][static_cast<size_t>(i)];
    const Eigen::Vector3d truth(10 * camera[0].get<double>(), 10 * camera[1].get<double>(),
                                10 * camera[2].get<double>());
    fmt::print(
        "photograph {}: {} markers, {} inner corners, off by ({:.2f}, {:.2f}) px, then {:.2f} px "
        "RMS; {} spots of paper: light at ({:.1f}, {:.1f}, {:.1f}) mm, published ({:.1f}, {:.1f}, "
        "{:.1f}), apart {:.1f} mm\n",
        i, detection.markers, errors.size(), mean.x(), mean.y(), rms, samples.size(), light.x(),
        light.y(), light.z(), truth.x(), truth.y(), truth.z(), (light - truth).norm());
    EXPECT_LT(mean.norm(), 8);  // 0.76 mm; their rectification goes through another plane
    EXPECT_LT(rms, 5);
  }
}

}  // namespace
}  // namespace glint
