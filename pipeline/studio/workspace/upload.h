// Photographs out of a multipart body, one after the other, and what became of each.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/files/json.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/photographs/received_photo.h"
#include "pipeline/studio/workspace/photo_intake.h"

namespace glint {

class Upload {
 public:
  // Received into `folder`; `take` keeps a photograph that is whole; `done` is called after each.
  Upload(std::filesystem::path folder, std::function<TakenPhoto(ReceivedPhoto*)> take,
         std::function<void()> done)
      : folder_(std::move(folder)), take_(std::move(take)), done_(std::move(done)) {}

  // {photographs: [{name, id, error}]}. Throws HttpError where nothing came, or the only one was
  // not to be had for a reason that is not its own: too large, disk full.
  Json Read(HttpBody* body);

 private:
  void Begin(const HttpPart& part);
  bool Append(std::string_view bytes);
  void Finish();
  void Fail(const HttpError& error);

  std::filesystem::path folder_;
  std::function<TakenPhoto(ReceivedPhoto*)> take_;
  std::function<void()> done_;
  Json list_ = Json::array();
  std::string name_;                      // of the one that comes in now
  std::unique_ptr<ReceivedPhoto> photo_;  // null: between two, or of a part that failed
  std::optional<HttpError> last_failure_;
};

}  // namespace glint
