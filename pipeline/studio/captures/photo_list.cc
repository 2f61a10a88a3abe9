#include "pipeline/studio/captures/photo_list.h"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "base/photos/photo_name.h"
#include "pipeline/studio/captures/library.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

using Places = std::vector<std::pair<std::string, bool>>;  // and whether it is left out

Places DescribedPlaces(const Capture& capture) {
  Places places;
  for (const std::string& place : capture.photos) places.emplace_back(place, false);
  for (const std::string& place : capture.left_out_photos) places.emplace_back(place, true);
  return places;
}

// A draft lists nothing.
Places PlacesIn(const fs::path& capture) {
  Places places;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(capture / "photos", error)) {
    const std::string name = file.path().filename();
    if (name[0] != '.' && file.is_regular_file(error)) places.emplace_back("photos/" + name, false);
  }
  return places;
}

}  // namespace

double ChangedAt_s(const fs::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return 0;
  constexpr double kNano = 1e-9;
  return static_cast<double>(facts.st_mtim.tv_sec) +
         kNano * static_cast<double>(facts.st_mtim.tv_nsec);
}

std::vector<StudioPhoto> PhotosOf(const CaptureState& state) {
  Places places;
  if (state.capture) {
    places = DescribedPlaces(*state.capture);
  } else if (state.draft) {
    places = PlacesIn(state.folder);
  }
  std::vector<StudioPhoto> photos;
  for (const auto& [place, left_out] : places) {
    const fs::path file = state.folder / place;
    photos.push_back({IdOf(place), fs::path(place).filename(), place, file, left_out,
                      ChangedAt_s(SplitPhotoName(file).file)});
  }
  std::stable_sort(photos.begin(), photos.end(), [](const StudioPhoto& a, const StudioPhoto& b) {
    return a.added_s != b.added_s ? a.added_s < b.added_s : a.name < b.name;
  });
  return photos;
}

}  // namespace glint
