#include "calib/capture/detect_photos.h"
#include "calib/capture/board_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <tuple>

#include "base/errors/errors.h"
#include "base/parallel/parallel.h"
#include "base/programs/progress.h"
#include "calib/capture/reduced_photo.h"
#include "calib/corners/markers.h"
#include "calib/guidance/clipping.h"

namespace glint {
namespace {

// From a reduced copy to the photograph itself.
void Enlarge(int reduction, std::pair<int, int> size, DetectedPhoto* photo) {
  photo->reduced = true;
  std::tie(photo->width_px, photo->height_px) = size;
  photo->picture.left_px *= reduction;
  photo->picture.top_px *= reduction;
  photo->picture.scale /= reduction;
  for (CornerObservation& corner : photo->detection.corners) {
    corner.point_px *= reduction;
    corner.sigma_px *= reduction;
    corner.blur_px *= reduction;
  }
  PhotoMeasures& measures = photo->measures;
  std::tie(measures.file.image.width, measures.file.image.height) = size;
  measures.blur_px *= reduction;
  measures.edge_px *= reduction;
}

DetectedPhoto DetectOne(const Capture& capture, const CalibOptions& options,
                        const std::vector<PaperSpot>& spots, const std::string& name,
                        bool board_photo) {
  const std::filesystem::path file = capture.folder / name;
  int reduction = 1;
  const Photo photo =
      options.quick_px > 0 ? ReadReducedPhoto(file, options.quick_px, &reduction) : ReadPhoto(file);
  DetectedPhoto detected;
  detected.name = name;
  detected.board_photo = board_photo;
  detected.width_px = photo.image.width;
  detected.height_px = photo.image.height;
  detected.orientation = photo.orientation;
  detected.focal_length_35mm = photo.focal_length_35mm;
  detected.camera_model = photo.camera_model;
  detected.clips = !photo.is_float();
  detected.exposure = photo.exposure();
  const Encoding encoding = ResolveEncoding(capture.resolved_encoding(), file, photo);
  if (!capture.has_board) {
    detected.picture = SamplePictureOf(photo, encoding, {}, capture.sample_size_mm);
    return detected;
  }
  DetectorOptions detector;
  detector.longest_px = options.detect_px;
  detector.min_corners = options.min_corners;
  const GrayImage gray = GrayFromPhoto(photo);
  detected.detection = DetectBoard(gray, capture.board, detector);
  detected.measures = MeasurePhoto(name, photo, gray, detected.detection);
  detected.measures.flash_photo = !board_photo;
  if (!board_photo && !detected.detection.corners.empty()) {
    detected.paper = SamplePaper(photo, encoding, capture.board, spots, detected.detection.corners);
    detected.sample_clipped_share =
        ClippedShareOfSample(photo, detected.detection.corners, capture.sample_size_mm);
  }
  if (!board_photo) {
    detected.picture = SamplePictureOf(photo, encoding, detected.detection.corners,
                                       capture.sample_size_mm, PlacesOfSample(capture.board));
  }
  if (reduction > 1) Enlarge(reduction, PhotoSize(file), &detected);
  return detected;
}

std::string Listed(const std::vector<const DetectedPhoto*>& photos) {
  constexpr size_t kMost = 6;
  std::string text;
  for (size_t i = 0; i < std::min(kMost, photos.size()); ++i) {
    text += "\n  " + photos[i]->name + ": " + photos[i]->detection.problem;
  }
  if (photos.size() > kMost) text += fmt::format("\n  and {} more", photos.size() - kMost);
  return text;
}

// " DICT_… shows 24 markers in photos/a.jpg": where the description names another dictionary.
std::string OtherDictionary(const Capture& capture, const CalibOptions& options,
                            const std::string& name) {
  if (BoardMarkers(capture.board).empty()) return "";
  int markers = 0;
  const std::string dictionary =
      GuessDictionary(GrayFromPhoto(ReadPhoto(capture.folder / name)), options.detect_px, &markers);
  if (dictionary.empty() || dictionary == capture.board.dictionary) return "";
  return fmt::format("\n  {} shows {} markers of {}", name, markers, dictionary);
}

}  // namespace

std::vector<DetectedPhoto> DetectPhotos(const Capture& capture, const CalibOptions& options,
                                        int threads) {
  cv::setNumThreads(1);  // photographs are what is shared out
  const size_t flash = capture.photos.size(), all = flash + capture.board_photos.size();
  const std::vector<PaperSpot> spots = PaperSpots(capture.board);
  std::vector<DetectedPhoto> photos(all);
  Progress progress("corners", static_cast<std::int64_t>(all));
  ForEachPiece(static_cast<int>(all), threads, [&](int piece) {
    const size_t i = static_cast<size_t>(piece);
    const std::string& name = i < flash ? capture.photos[i] : capture.board_photos[i - flash];
    photos[i] = DetectOne(capture, options, spots, name, i >= flash);
    progress.Advance(1, name);
  });
  return photos;
}

void RequireBoard(const Capture& capture, const CalibOptions& options,
                  const std::vector<DetectedPhoto>& photos) {
  std::vector<const DetectedPhoto*> seen, placed, failed, mismatched, partly;
  for (const DetectedPhoto& photo : photos) {
    const BoardDetection& detection = photo.detection;
    if (detection.mismatch) mismatched.push_back(&photo);
    if (detection.corners.empty()) {
      failed.push_back(&photo);
      continue;
    }
    seen.push_back(&photo);
    if (!detection.position_known) partly.push_back(&photo);
    if (!photo.board_photo && detection.position_known) placed.push_back(&photo);
  }
  if (!mismatched.empty() && mismatched.size() >= seen.size()) {
    throw UserError(capture.file, "board",
                    fmt::format("a board that does not fit the description in {} of {} photographs",
                                mismatched.size(), photos.size()),
                    "see what is wrong:" + Listed(mismatched));
  }
  if (seen.empty()) {
    throw UserError(capture.file, "photos",
                    fmt::format("the board in none of the {} photographs", photos.size()),
                    "check [board], or photograph the sample with the board round it:" +
                        Listed(failed) + OtherDictionary(capture, options, photos[0].name));
  }
  if (seen.size() == 1 && photos.size() > 1 && options.fix_intrinsics.empty()) {
    throw UserError(capture.file, "photos",
                    fmt::format("the board in only one of the {} photographs ({})", photos.size(),
                                seen[0]->name),
                    "at least two are needed; check [board], or take more photographs with the "
                    "whole board in them:" +
                        Listed(failed));
  }
  if (placed.empty() && !partly.empty()) {
    throw UserError(
        capture.file, "board",
        fmt::format("a whole board in none of the {} photographs", photos.size()),
        "correct inner_corners (or squares), or take photographs with the whole board in "
        "them:" +
            Listed(partly));
  }
  if (placed.empty()) {
    throw UserError(capture.file, "photos.files",
                    "the board only in the photographs listed in [board], in none of the sample",
                    "photograph the sample with the board round it:" + Listed(failed));
  }
}

}  // namespace glint
