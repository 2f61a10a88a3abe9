#include "calib/capture/camera_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/camera/orientation.h"
#include "base/errors/errors.h"
#include "base/text/name_list.h"

namespace glint {
namespace {

constexpr size_t kSmallGroup = 2;  // photographs; too few to give intrinsics of their own

// Stored width and height, mirrored or not, camera, focal length in tenths of a millimetre.
using Key = std::tuple<int, int, bool, std::string, long>;

Key KeyOf(const DetectedPhoto& photo, int turns) {
  const bool mirrored = !QuarterTurns(photo.orientation);
  int width = photo.width_px, height = photo.height_px;
  if (turns % 2 == 1) std::swap(width, height);
  return {width, height, mirrored, photo.camera_model, std::lround(10 * photo.focal_length_35mm)};
}

Key TurnedKey(Key key) {
  std::swap(std::get<0>(key), std::get<1>(key));
  return key;
}

// Whether a picture stored upright is of a camera whose others are stored as wide as it is high:
// sensors lie across.
bool IsTurned(const Key& key, const std::vector<Key>& all) {
  return std::get<0>(key) < std::get<1>(key) &&
         std::find(all.begin(), all.end(), TurnedKey(key)) != all.end();
}

std::string Size(const CameraGroup& group) {
  return fmt::format("{}x{} pixels", group.width_px, group.height_px);
}

// What the strays of a group have and the others have not.
std::string StrayReason(const std::vector<DetectedPhoto>& photos, const CameraGroup& group,
                        const CameraGroup& largest) {
  const std::string remedy =
      "; a screenshot, a crop or another camera? To use it, take at least three such photographs "
      "or give --cameras each";
  if (group.width_px != largest.width_px || group.height_px != largest.height_px) {
    return fmt::format("it has {}, while {} other photographs have {}", Size(group),
                       largest.photos.size(), Size(largest)) +
           remedy;
  }
  const DetectedPhoto& photo = photos[group.photos[0]];
  const DetectedPhoto& other = photos[largest.photos[0]];
  return fmt::format("EXIF says '{}' at {} mm, while {} other photographs have '{}' at {} mm",
                     photo.camera_model, photo.focal_length_35mm, largest.photos.size(),
                     other.camera_model, other.focal_length_35mm) +
         remedy;
}

}  // namespace

CameraGroups GroupCameras(const std::filesystem::path& capture_file, const std::string& cameras,
                          const std::vector<DetectedPhoto>& photos, bool turned_pixels) {
  CameraGroups groups;
  std::vector<Key> keys, stored;
  for (const DetectedPhoto& photo : photos) {
    stored.push_back(KeyOf(photo, QuarterTurns(photo.orientation).value_or(0)));
  }
  for (size_t i = 0; i < photos.size(); ++i) {
    const int turns = QuarterTurns(photos[i].orientation).value_or(0);
    Key key = KeyOf(photos[i], turns);
    const bool turned =
        turned_pixels && !photos[i].board_photo && cameras != "each" && IsTurned(key, stored);
    if (turned) key = TurnedKey(key);
    groups.surely_turned.push_back(turned);
    groups.pixel_turns.push_back(turned ? 1 : 0);
    groups.turns.push_back((turns + groups.pixel_turns.back()) % 4);
    auto found = keys.end();
    if (cameras == "auto") found = std::find(keys.begin(), keys.end(), key);
    if (cameras == "one" && !keys.empty()) {
      found = keys.begin();
      if (std::get<0>(key) != std::get<0>(*found) || std::get<1>(key) != std::get<1>(*found)) {
        throw UserError(
            capture_file.parent_path() / photos[i].name, "size",
            fmt::format("{}x{} pixels, while {} has {}x{}", std::get<0>(key), std::get<1>(key),
                        photos[0].name, std::get<0>(*found), std::get<1>(*found)),
            "remove it, or give --cameras auto");
      }
    }
    const size_t at = static_cast<size_t>(found - keys.begin());
    if (found == keys.end()) {
      keys.push_back(key);
      groups.groups.push_back({std::get<0>(key), std::get<1>(key), {}});
    }
    groups.group.push_back(static_cast<int>(at));
    groups.groups[at].photos.push_back(i);
  }
  return groups;
}

std::string ManySizesInWords(const std::vector<DetectedPhoto>& photos) {
  constexpr size_t kLeast = 3;
  std::vector<std::string> sizes;
  size_t count = 0;
  for (const DetectedPhoto& photo : photos) {
    if (photo.detection.corners.empty()) continue;
    ++count;
    const auto [shorter, longer] = std::minmax(photo.width_px, photo.height_px);
    std::string size = fmt::format("{}x{}", longer, shorter);
    if (std::find(sizes.begin(), sizes.end(), size) == sizes.end()) sizes.push_back(size);
  }
  if (sizes.size() < kLeast || 2 * sizes.size() <= count) return "";
  return fmt::format(
      "{} photographs have {} different sizes in pixels ({}), as if each had been cropped or "
      "resized "
      "by "
      "hand: the centre of the lens would be elsewhere in each. Use the camera's own files, as "
      "they "
      "are",
      count, sizes.size(), NameList(sizes));
}

void LeaveOut(const std::string& reason, DetectedPhoto* photo) {
  photo->detection.corners.clear();
  photo->detection.problem = reason;
  photo->detection.mismatch = false;
  photo->paper.clear();
}

void LeaveOutStrays(const CameraGroups& groups, std::vector<DetectedPhoto>* photos) {
  const auto largest = std::max_element(
      groups.groups.begin(), groups.groups.end(),
      [](const CameraGroup& a, const CameraGroup& b) { return a.photos.size() < b.photos.size(); });
  if (largest == groups.groups.end() || largest->photos.size() <= kSmallGroup) return;
  for (const CameraGroup& group : groups.groups) {
    if (group.photos.size() > kSmallGroup) continue;
    const std::string reason = StrayReason(*photos, group, *largest);
    for (const size_t i : group.photos) {
      LeaveOut(reason, &(*photos)[i]);
    }
  }
}

double ReportedFocal_px(const std::vector<DetectedPhoto>& photos, const CameraGroup& group) {
  for (const size_t index : group.photos) {
    const DetectedPhoto& photo = photos[index];
    const ExifFacts& exif = photo.measures.file.exif;
    if (photo.focal_length_35mm <= 0 || exif.digital_zoom > 1.01) continue;
    // A cropped picture has another diagonal than the tag is about.
    const double diagonal_px = std::hypot(group.width_px, group.height_px);
    const double exif_px = std::hypot(exif.width_px, exif.height_px);
    const bool cropped =
        exif_px > 0 && std::abs(std::max(exif.width_px, exif.height_px) * diagonal_px /
                                    (std::max(group.width_px, group.height_px) * exif_px) -
                                1) > 0.01;
    if (!cropped) return photo.focal_length_35mm / kFilmDiagonal_mm * diagonal_px;
  }
  return 0;
}

BundleProblem MakeProblem(const std::vector<DetectedPhoto>& photos, const CameraGroups& groups,
                          std::vector<size_t>* photo_index) {
  BundleProblem problem;
  for (const CameraGroup& group : groups.groups) {
    problem.cameras.push_back(
        {group.width_px, group.height_px, std::nullopt, ReportedFocal_px(photos, group)});
  }
  for (size_t i = 0; i < photos.size(); ++i) {
    if (photos[i].detection.corners.empty()) continue;
    BundlePhoto photo{photos[i].name, groups.group[i], {}};
    for (const CornerObservation& corner : photos[i].detection.corners) {
      photo.corners.push_back({corner.id, corner.position_in_sample_mm,
                               TurnedImagePoint(corner.point_px, photos[i].width_px,
                                                photos[i].height_px, -groups.turns[i])});
    }
    problem.photos.push_back(std::move(photo));
    photo_index->push_back(i);
  }
  return problem;
}

}  // namespace glint
