#include "pipeline/studio/workspace/killed_studio.h"

#include <functional>
#include <string>
#include <string_view>

#include "base/errors/errors.h"
#include "pipeline/studio/captures/new_capture.h"
#include "pipeline/studio/photographs/received_photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

void RemoveThose(const fs::path& folder, const std::function<bool(const std::string&)>& is_one) {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_one(entry.path().filename())) found.push_back(entry.path());
  }
  for (const fs::path& path : found) fs::remove_all(path, error);
}

bool IsHalfMadeCapture(const std::string& name) { return name.starts_with("new-"); }

// As WriteFileAtomically names it, and nobody else: with the number of a process.
bool IsUnfinishedDescription(const std::string& name) {
  constexpr std::string_view kBegin = "capture.toml.tmp";
  return name.size() > kBegin.size() && name.starts_with(kBegin) &&
         name.find_first_not_of("0123456789", kBegin.size()) == std::string::npos;
}

// The capture's own page says what is wrong with a draft that cannot become a capture.
void TryToFinishDraft(const fs::path& capture) {
  try {
    FinishDraft(capture);
  } catch (const Error&) {
  }
}

}  // namespace

void TidyAfterKilledStudio(const fs::path& root, const std::vector<LibraryEntry>& captures) {
  RemoveThose(root / kStudioFolder, IsHalfMadeCapture);
  for (const LibraryEntry& entry : captures) {
    ReceivedPhoto::RemoveLeftovers(entry.folder / "photos");
    RemoveThose(entry.folder, IsUnfinishedDescription);
    TryToFinishDraft(entry.folder);
  }
}

}  // namespace glint
