#include "pipeline/studio/captures/capture_state.h"

#include "base/errors/errors.h"
#include "pipeline/studio/captures/option_form.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {
namespace {

// The capture's own folder goes without saying.
ProgramMessage ProblemOf(std::string text, const std::filesystem::path& folder) {
  const std::string prefix = folder.string() + "/";
  if (text.starts_with(prefix)) text = text.substr(prefix.size());
  return SplitMessage(text);
}

}  // namespace

CaptureState ReadState(const std::filesystem::path& folder) {
  CaptureState state;
  state.folder = folder;
  try {
    if (IsDraft(folder)) {
      state.draft = ReadDraft(folder);
    } else {
      state.capture = ReadCapture(folder, Photographs::kMayBeMissing);
    }
  } catch (const Error& error) {
    state.problem = ProblemOf(error.what(), folder);
  }
  return state;
}

std::string KindOf(const CaptureState& state) {
  if (state.draft) return state.draft->kind;
  if (!state.capture) return "board";
  if (state.capture->fixed_camera()) return "fixed camera";
  if (state.capture->has_board) return "board";
  if (state.capture->imported()) return "rectified";
  return "single";
}

bool IsOfOnePhotograph(const CaptureState& state) {
  if (state.draft) return state.draft->kind == "single";
  if (!state.capture) return false;
  const Json saved = SavedOptions(*state.capture);
  return saved.contains("calib") && saved["calib"].value("poses", "") == "above";
}

void RequireDescription(const std::filesystem::path& folder) {
  if (!IsDraft(folder)) return;
  throw HttpError{409, "the capture has no photograph yet", "send one first"};
}

}  // namespace glint
