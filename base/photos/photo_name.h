// How photographs are named: files, and frames of videos ("photos/clip.mp4#0030").
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace glint {

// Whether the file name's ending is that of a video (MP4, MOV, AVI, MKV, WEBM…).
bool IsVideoFileName(const std::filesystem::path& file);

// "clip.mp4#0030": the file, and the frame counted from 0 in the order of showing. Other names are
// files, whatever signs they hold: frame −1.
struct PhotoName {
  std::filesystem::path file;
  int frame = -1;
};
PhotoName SplitPhotoName(const std::filesystem::path& name);
std::string FrameName(const std::string& video, int frame);

// The files behind photographs' names, each once, in the order in which they come up.
std::vector<std::string> FilesOfPhotos(const std::vector<std::string>& names);

// Whether `name`, as a person writes it, is this photograph's path, file name, or file name without
// its ending.
bool NamesPhoto(const std::string& name, const std::string& photo);

// Lists of names are separated by commas, which file names may hold too: puts together again what
// is known only as a whole ("a", "b.jpg" of "a,b.jpg"). Parts that stay unknown are left alone.
std::vector<std::string> RejoinedNames(const std::vector<std::string>& parts,
                                       const std::function<bool(const std::string&)>& known);

}  // namespace glint
