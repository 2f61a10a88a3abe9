#include "pipeline/studio/workspace/upload.h"

#include "base/errors/errors.h"
#include "pipeline/studio/captures/program_message.h"

namespace glint {

void Upload::Begin(const HttpPart& part) {
  constexpr size_t kMostParts = 1000;
  constexpr size_t kMostOfName = 200;
  if (part.field != "photographs" || list_.size() >= kMostParts) return;
  name_ = part.file_name.substr(0, kMostOfName);
  photo_ = std::make_unique<ReceivedPhoto>(folder_, part.file_name);
}

bool Upload::Append(std::string_view bytes) {
  if (!photo_) return true;  // of a part that failed already: read over
  try {
    photo_->Append(bytes);
  } catch (const HttpError& error) {
    Fail(error);
    return error.status != 507;
  }
  return true;
}

void Upload::Finish() {
  if (!photo_) return;
  try {
    const TakenPhoto taken = take_(photo_.get());
    list_.push_back({{"name", name_}, {"id", taken.id}, {"error", nullptr}});
    if (taken.was_there) list_.back()["same"] = true;
    photo_.reset();
  } catch (const HttpError& error) {
    Fail(error);
  } catch (const Error& error) {
    const ProgramMessage said = SplitMessage(error.what());
    Fail({500, said.message, said.remedy});
  }
  done_();
}

void Upload::Fail(const HttpError& error) {
  const std::string remedy = error.remedy.empty() ? "" : "; " + error.remedy;
  list_.push_back({{"name", name_}, {"id", nullptr}, {"error", error.message + remedy}});
  last_failure_ = error;
  photo_.reset();
}

Json Upload::Read(HttpBody* body) {
  const bool all = body->Parts(
      [&](const HttpPart& part) {
        Finish();
        Begin(part);
        return true;
      },
      [&](std::string_view bytes) { return Append(bytes); });
  if (all) {
    Finish();
  } else if (photo_) {
    Fail({400, "the connection ended before the photograph had arrived", "send it again"});
  }
  if (list_.empty()) {
    throw HttpError{all ? 415 : 400, "found no photographs in the request",
                    "send them in the field photographs"};
  }
  const bool not_its_own =
      last_failure_ && (last_failure_->status >= 500 || last_failure_->status == 413);
  if (list_.size() == 1 && not_its_own) throw *last_failure_;
  return {{"photographs", list_}};
}

}  // namespace glint
