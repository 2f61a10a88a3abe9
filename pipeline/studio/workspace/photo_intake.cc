#include "pipeline/studio/workspace/photo_intake.h"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/files/hash.h"
#include "pipeline/studio/captures/capture_edit.h"
#include "pipeline/studio/captures/notes.h"
#include "pipeline/studio/captures/photo_list.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/workspace/photo_review.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

bool HasBytes(const fs::path& file, const std::string& hash, std::uintmax_t bytes) {
  std::error_code error;
  return fs::file_size(file, error) == bytes && !error && HashFile(file) == hash;
}

std::optional<std::string> IdOfSameBytes(const std::vector<StudioPhoto>& photos,
                                         const std::string& hash, std::uintmax_t bytes) {
  for (const StudioPhoto& one : photos) {
    if (HasBytes(one.file, hash, bytes)) return one.id;
  }
  return std::nullopt;
}

// Of a Studio that was killed after it had kept the photograph and before capture.toml listed it.
std::optional<fs::path> UnlistedOfSameBytes(const fs::path& capture, const std::string& hash,
                                            std::uintmax_t bytes) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(capture / "photos", error)) {
    const bool hidden = entry.path().filename().string()[0] == '.';
    if (!hidden && entry.is_regular_file(error) && HasBytes(entry.path(), hash, bytes)) {
      return entry.path();
    }
  }
  return std::nullopt;
}

void RequireRoomFor(const CaptureState& state, const std::vector<StudioPhoto>& photos) {
  if (photos.size() >= kMostPhotographs) {
    throw HttpError{413, "the capture has 1000 photographs", "make another capture"};
  }
  const bool one_is_used = std::any_of(photos.begin(), photos.end(),
                                       [](const StudioPhoto& other) { return !other.left_out; });
  if (IsOfOnePhotograph(state) && one_is_used) {
    throw HttpError{409, "this capture takes one photograph, and it already has one",
                    "leave that one out first, or make a capture with a board for several"};
  }
}

// Whoever sent a photograph that cannot be listed is told, and still has it.
void ListOrRemove(const fs::path& capture, const fs::path& file) {
  try {
    ListPhoto(capture, file);
  } catch (...) {
    ::unlink(file.c_str());
    throw;
  }
}

}  // namespace

TakenPhoto TakeIn(const LibraryEntry& entry, const std::string& hash, ReceivedPhoto* photo,
                  CheckQueue* checks) {
  const CaptureState state = ReadState(entry.folder);
  if (!state.problem.message.empty()) {
    throw HttpError{409, state.problem.message, state.problem.remedy};
  }
  const auto photos = PhotosOf(state);
  if (const auto same = IdOfSameBytes(photos, hash, photo->size())) return {*same, true};
  RequireRoomFor(state, photos);
  const auto unlisted = UnlistedOfSameBytes(entry.folder, hash, photo->size());
  const fs::path file = unlisted ? *unlisted : photo->Keep();
  const std::string place = file.lexically_relative(entry.folder).generic_string();
  std::set<std::string> undecided = UndecidedPhotos(entry.folder);
  undecided.insert(place);
  NoteUndecided(entry.folder, undecided);
  if (unlisted) {
    ListPhoto(entry.folder, file);
  } else {
    ListOrRemove(entry.folder, file);
  }
  checks->Look(entry.id, file, TaskOf(ReadState(entry.folder)), CheckFolderOf(entry.folder));
  return {IdOf(place), unlisted.has_value()};
}

}  // namespace glint
