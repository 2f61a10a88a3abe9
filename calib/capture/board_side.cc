#include "calib/capture/board_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/text/name_list.h"
#include "calib/corners/local_homography.h"

namespace glint {
namespace {

constexpr int kSide = 96;      // of a patch of the sample
constexpr double kDetail = 6;  // pixels of it: what is coarser is the light's

Eigen::Vector2d OtherSide(const Board& board, const Eigen::Vector2d& at_mm) {
  return 2 * board.board_centre_in_sample_mm - at_mm;
}

// The sample's texture of unit length as the corners have it, or as from the other side; empty: not
// in the photograph.
cv::Mat Texture(const Capture& capture, const DetectedPhoto& photo, bool turned) {
  if (photo.picture.width == 0 || photo.detection.corners.size() < 4) return {};
  std::vector<PlanePoint> points;
  for (const CornerObservation& corner : photo.detection.corners) {
    const Eigen::Vector2d& at = corner.position_in_sample_mm;
    points.push_back({turned ? OtherSide(capture.board, at) : at, corner.point_px});
  }
  const auto h = FitHomography(points);
  if (!h) return {};
  const SamplePicture& picture = photo.picture;
  const cv::Mat values(picture.height, picture.width, CV_16U,
                       const_cast<std::uint16_t*>(picture.values.data()));
  cv::Mat columns(kSide, kSide, CV_32F), rows(kSide, kSide, CV_32F), patch;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector2d at(((x + 0.5) / kSide - 0.5) * capture.sample_size_mm[0],
                               (0.5 - (y + 0.5) / kSide) * capture.sample_size_mm[1]);
      const Eigen::Vector2d seen = ApplyHomography(*h, at).value_or(Eigen::Vector2d(-1e6, -1e6));
      columns.at<float>(y, x) =
          static_cast<float>((seen.x() - picture.left_px) * picture.scale - 0.5);
      rows.at<float>(y, x) = static_cast<float>((seen.y() - picture.top_px) * picture.scale - 0.5);
    }
  }
  cv::Mat full;
  values.convertTo(full, CV_32F);
  cv::remap(full, patch, columns, rows, cv::INTER_AREA, cv::BORDER_REPLICATE);
  cv::log(patch + 650, patch);  // a hundredth of white: below, noise
  cv::Mat coarse;
  cv::GaussianBlur(patch, coarse, {0, 0}, kDetail);
  patch -= coarse;
  patch -= cv::mean(patch);
  // Highlights of single photographs must not outweigh the texture.
  cv::Mat size;
  cv::meanStdDev(patch, coarse, size);
  const double limit = 3 * size.at<double>(0);
  patch = cv::min(cv::max(patch, -limit), limit);
  const double length = cv::norm(patch);
  return length > 0 ? cv::Mat(patch / length) : cv::Mat();
}

// Per photograph: its texture as numbered, and from the other side.
using Textures = std::vector<std::array<cv::Mat, 2>>;

// By how much a photograph's texture agrees better with the others' from the other side.
double GainOfTurning(const Textures& textures, const std::vector<int>& sides, size_t photo) {
  double gain = 0;
  int others = 0;
  for (size_t i = 0; i < textures.size(); ++i) {
    if (i == photo || textures[i][0].empty()) continue;
    const cv::Mat& other = textures[i][sides[i]];
    gain += textures[photo][1 - sides[photo]].dot(other) - textures[photo][sides[photo]].dot(other);
    ++others;
  }
  return others > 0 ? gain / others : 0;
}

// What a gain must exceed: five standard deviations of that of random textures whose grain is three
// pixels of the patch, or of the picture, wide.
double LeastGain(const std::vector<DetectedPhoto>& photos, size_t others) {
  constexpr double kGrain = 3, kSigmas = 5;
  double pixels = kSide * kSide;
  for (const DetectedPhoto& photo : photos) {
    const double shown = photo.picture.width * static_cast<double>(photo.picture.height);
    if (shown > 0) pixels = std::min(pixels, shown / (kSampleMargin * kSampleMargin));
  }
  const double grains = pixels / (kGrain * kGrain);
  return kSigmas * std::sqrt(2 / (grains * static_cast<double>(others)));
}

// Each photograph's side, from all as numbered on. Turns the one that gains most until none does.
std::vector<int> SidesOf(const Textures& textures) {
  std::vector<int> sides(textures.size(), 0);
  for (size_t round = 0; round < 2 * textures.size(); ++round) {
    double most = 0;
    size_t which = 0;
    for (size_t i = 0; i < textures.size(); ++i) {
      if (textures[i][0].empty()) continue;
      const double gain = GainOfTurning(textures, sides, i);
      if (gain > most) most = gain, which = i;
    }
    if (most < 1e-6) break;
    sides[which] = 1 - sides[which];
  }
  // Both ways round are one: the first photograph's is kept.
  const auto first = std::find_if(textures.begin(), textures.end(),
                                  [](const auto& texture) { return !texture[0].empty(); });
  if (first != textures.end() && sides[first - textures.begin()] == 1) {
    for (int& side : sides) side = 1 - side;
  }
  return sides;
}

void TurnCorners(const Board& board, DetectedPhoto* photo) {
  const int last = (board.squares_x - 1) * (board.squares_y - 1) - 1;
  for (CornerObservation& corner : photo->detection.corners) {
    corner.id = last - corner.id;
    corner.position_in_sample_mm = OtherSide(board, corner.position_in_sample_mm);
  }
  std::reverse(photo->detection.corners.begin(), photo->detection.corners.end());
  for (PaperSample& sample : photo->paper) {
    sample.position_in_sample_mm = OtherSide(board, sample.position_in_sample_mm);
  }
}

}  // namespace

std::vector<Eigen::Vector2d> PlacesOfSample(const Board& board) {
  std::vector<Eigen::Vector2d> places = {{0, 0}};
  if (LooksTheSameUpsideDown(board)) places.push_back(OtherSide(board, {0, 0}));
  return places;
}

std::vector<std::string> SettleBoardSides(const Capture& capture,
                                          std::vector<DetectedPhoto>* photos) {
  if (!LooksTheSameUpsideDown(capture.board)) return {};
  Textures textures;
  size_t seen = 0;
  for (const DetectedPhoto& photo : *photos) {
    textures.push_back({Texture(capture, photo, false), Texture(capture, photo, true)});
    if (textures.back()[1].empty()) textures.back()[0] = cv::Mat();
    seen += !textures.back()[0].empty();
  }
  if (seen < 2) return {};
  const std::vector<int> sides = SidesOf(textures);
  const double least = LeastGain(*photos, seen - 1);
  std::vector<std::string> turned, untold;
  for (size_t i = 0; i < photos->size(); ++i) {
    if (textures[i][0].empty()) continue;
    if (-GainOfTurning(textures, sides, i) < least) {
      untold.push_back((*photos)[i].name);
    } else if (sides[i] == 1) {
      turned.push_back((*photos)[i].name);
      TurnCorners(capture.board, &(*photos)[i]);
    }
  }
  std::vector<std::string> words;
  const std::string remedy =
      "a board with an odd number of squares on one side and an even number on the other, or one "
      "with markers (glint board), has only one way up";
  if (!turned.empty()) {
    words.push_back(fmt::format(
        "{}: taken from the other side of the checkerboard, which looks the same upside down; the "
        "sample's texture shows this, and they are turned accordingly. {}",
        NameList(turned, 4), "To rule this out: " + remedy));
  }
  if (!untold.empty()) {
    words.push_back(
        fmt::format("the checkerboard looks the same upside down, and the sample's texture does "
                    "not show which way round it lies in {}: if you walked round the table, some "
                    "photographs are taken to be the wrong way up; {}",
                    NameList(untold, 4), remedy));
  }
  return words;
}

}  // namespace glint
