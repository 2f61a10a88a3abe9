#include "pipeline/studio/routes/replies.h"

#include "pipeline/studio/captures/program_message.h"
#include "pipeline/studio/page/page_files.h"
#include "pipeline/studio/runs/results.h"

namespace glint {

HttpReply JsonReply(const Json& json) {
  HttpReply reply;
  reply.body = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return reply;
}

HttpReply FileReply(const std::filesystem::path& file, const std::string& type) {
  HttpReply reply;
  reply.file = OpenToSend(file);
  if (!reply.file) ThrowNotFound();
  reply.type = type;
  return reply;
}

HttpReply PageReply(const std::string& name) {
  const PageFile file = FindPageFile(name);
  if (file.type.empty()) ThrowNotFound();
  HttpReply reply;
  if (file.bytes.empty()) {
    reply.status = 503;
    reply.type = "text/plain; charset=utf-8";
    reply.body =
        "This build of Glint has no pages for Studio: install node and npm, let them reach the npm "
        "registry once, and build again.\n";
    return reply;
  }
  reply.type = file.type;
  reply.body = std::string(file.bytes);
  return reply;
}

HttpError ToldWith(int status, const Error& error) {
  const ProgramMessage said = SplitMessage(error.what());
  return {status, said.message, said.remedy};
}

void ThrowNotFound() {
  throw HttpError{404, "there is nothing at this address", "use the links of the page"};
}

}  // namespace glint
