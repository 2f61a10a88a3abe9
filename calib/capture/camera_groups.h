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
  // Clockwise quarter turns that each photograph's pixels had before EXIF's orientation, which does
  // not tell of them; part of `turns`.
  std::vector<int> pixel_turns;     // empty: not looked for
  std::vector<bool> surely_turned;  // of each photograph: by its size, if not to which side
};

// cameras = "auto": one group per stored size, EXIF camera and focal length; photographs whose size
// is that of others turned by 90° are of the same camera, their pixels turned to an unknown side,
// unless `turned_pixels` is false; "one": a single group; "each": a group per photograph. Throws
// UserError naming the photograph of another size where there is to be one camera.
CameraGroups GroupCameras(const std::filesystem::path& capture_file, const std::string& cameras,
                          const std::vector<DetectedPhoto>& photos, bool turned_pixels = true);

// Where photographs have nearly as many sizes as they are: that they were cropped by hand, and what
// to do; "": they were not.
std::string ManySizesInWords(const std::vector<DetectedPhoto>& photos);

// Takes a photograph's corners and paper from it; `reason` becomes its detection.problem.
void LeaveOut(const std::string& reason, DetectedPhoto* photo);

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
