#include "pipeline/studio/captures/capture_edit.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/files/files.h"
#include "pipeline/studio/captures/new_capture.h"
#include "pipeline/studio/captures/toml_edit.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {

void EditCapture(const std::filesystem::path& folder,
                 const std::function<std::string(const Capture&, const std::string&)>& edit) {
  constexpr int kAttempts = 5;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Capture capture = ReadCapture(folder, Photographs::kMayBeMissing);
    const std::string text = ReadTextFile(capture.file);
    const std::string changed = edit(capture, text);
    if (changed == text) return;
    if (ReadTextFile(capture.file) != text) continue;
    WriteFileAtomically(capture.file, changed);
    return;
  }
  throw HttpError{409, "capture.toml is being changed by somebody else", "try again"};
}

void ListPhoto(const std::filesystem::path& folder, const std::filesystem::path& file) {
  if (IsDraft(folder)) return FinishDraft(folder);
  const std::string place = file.lexically_relative(folder).generic_string();
  EditCapture(folder, [&](const Capture& capture, const std::string& text) {
    const auto has = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), place) != list.end();
    };
    if (has(capture.photos) || has(capture.left_out_photos)) return text;
    return WithTomlListItem(capture.file, text, "photos", "files",
                            "photos/*" + file.extension().string());
  });
}

void EditLeftOut(const std::filesystem::path& folder,
                 const std::function<void(std::set<std::string>*)>& edit) {
  EditCapture(folder, [&](const Capture& capture, const std::string& text) {
    std::set<std::string> places(capture.left_out_photos.begin(), capture.left_out_photos.end());
    edit(&places);
    return WithTomlValue(capture.file, text, "photos", "left_out",
                         places.empty() ? std::nullopt : std::optional<Json>(Json(places)));
  });
}

}  // namespace glint
