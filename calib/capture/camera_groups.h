// Which photographs share their intrinsics.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/bundle/bundle.h"
#include "calib/capture/detect_photos.h"

namespace glint {

// A camera with its photographs. Intrinsics are those of the stored picture; `turns` says how often
// each photograph was turned to be upright (see camera/orientation.h).
struct CameraGroup {
  int width_px = 0, height_px = 0;
  std::vector<size_t> photos;  // indices into the detected photographs, those without corners too
};

struct CameraGroups {
  std::vector<CameraGroup> groups;  // in the order of their first photograph
  std::vector<int> group;           // of each photograph
  std::vector<int> turns;           // of each photograph
};

// cameras = "auto": one group per stored size, EXIF camera and focal length; "one": a single group;
// "each": a group per photograph. Throws UserError naming the photograph of another size where
// there is to be one camera.
CameraGroups GroupCameras(const std::filesystem::path& capture_file, const std::string& cameras,
                          const std::vector<DetectedPhoto>& photos);

// Photographs whose size or focal length stands alone (a group of one or two beside larger ones)
// are mistakes, not cameras: their corners are taken from them, and detection.problem says why.
void LeaveOutStrays(const CameraGroups& groups, std::vector<DetectedPhoto>* photos);

inline constexpr double kFilmDiagonal_mm = 43.2666;  // 36 × 24

// Focal length in pixels reported by EXIF: its 35 mm equivalent, which is about the diagonal (CIPA
// DCG-001). 0: no photograph of the group reports one, or they were cropped or zoomed.
double ReportedFocal_px(const std::vector<DetectedPhoto>& photos, const CameraGroup& group);

// The bundle adjustment of all photographs with corners, in stored pictures. `photo_index` returns
// which detected photograph each of its photos is.
BundleProblem MakeProblem(const std::vector<DetectedPhoto>& photos, const CameraGroups& groups,
                          std::vector<size_t>* photo_index);

}  // namespace glint
