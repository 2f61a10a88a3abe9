#include "datasets/evaluation/capture_store.h"

#include <algorithm>

#include "base/errors/errors.h"
#include "base/formats/rectified_set.h"
#include "datasets/evaluation/link_files.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// What a set of views consists of; the last makes it complete.
const fs::path kParts[] = {"photos", "truth", "capture.toml",
                           ImportedViewsManifest("glint").parent_path()};

// Files that other captures may share must not be written over in place.
void RemoveViews(const fs::path& capture) {
  for (const fs::path& part : kParts) fs::remove_all(capture / part);
}

void LinkViews(const fs::path& from, const fs::path& to) {
  for (const fs::path& part : kParts) {
    if (fs::is_regular_file(from / part)) {
      LinkOrCopy(from / part, to / part);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(from / part)) {
      if (!entry.is_regular_file()) continue;
      LinkOrCopy(entry.path(), to / fs::relative(entry.path(), from));
    }
  }
}

}  // namespace

CaptureStore::CaptureStore(const MaterialSource& material, const ViewSetOptions& views,
                           const CommonOptions& common)
    : material_(material), views_(views), common_(common) {}

void CaptureStore::Provide(const fs::path& capture) {
  if (std::find(made_.begin(), made_.end(), capture) != made_.end()) return;
  try {
    RemoveViews(capture);
    if (made_.empty()) {
      WriteViewSet(capture, material_, views_, common_);
    } else {
      LinkViews(made_.front(), capture);
    }
  } catch (const fs::filesystem_error& error) {
    throw EnvironmentError(capture.string() + ": views cannot be written: " + error.what());
  }
  made_.push_back(capture);
}

void CaptureStore::ShareFit(const fs::path& fitted, const fs::path& capture) const {
  const fs::path part = fs::path("glint") / "fit";
  try {
    LinkFolder(fitted / part, capture / part);
  } catch (const fs::filesystem_error& error) {
    throw EnvironmentError(capture.string() + ": the fit cannot be shared: " + error.what());
  }
}

ReflectanceConvention CaptureStore::convention() const {
  return views_.rule == "dir" ? ReflectanceConvention::Dir2019()
                              : ReflectanceConvention::Photograph();
}

}  // namespace glint
