// What is read from each photograph of a folder, as a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/triage/triage.h"

namespace glint {

struct ListedPhoto {
  std::string name;     // relative to the folder
  std::string problem;  // why it cannot be read; empty: it can
  PhotoMeasures measures;
};

// Photographs of the folder and its sub-folders, by their names' endings; of a video the first
// frame. One is in memory at a time. Throws UserError: no folder, or no photograph in it.
std::vector<ListedPhoto> ListPhotos(const std::filesystem::path& folder);

// What a photograph's own EXIF contradicts; photographs of a folder need not belong together.
std::vector<std::string> OwnRemarks(const ListedPhoto& photo);

// Markdown: file, pixels, format, turn, camera, focal length, exposure, what is worth a word.
std::string TableOf(const std::vector<ListedPhoto>& photos);
Json ToJson(const std::vector<ListedPhoto>& photos);

}  // namespace glint
