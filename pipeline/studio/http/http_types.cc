#include "pipeline/studio/http/http_types.h"

#include <unistd.h>

#include "base/files/json.h"

namespace glint {

std::string HttpRequest::Header(const std::string& lower_case_name) const {
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? "" : found->second;
}

std::string HttpRequest::Cookie(const std::string& name) const {
  const std::string all = Header("cookie"), wanted = name + "=";
  for (size_t at = 0; at < all.size();) {
    size_t end = all.find(';', at);
    if (end == std::string::npos) end = all.size();
    while (at < end && all[at] == ' ') ++at;
    const std::string one = all.substr(at, end - at);
    if (one.starts_with(wanted)) return one.substr(wanted.size());
    at = end + 1;
  }
  return "";
}

std::vector<std::string> HttpRequest::Segments() const {
  std::vector<std::string> segments;
  for (size_t at = 1; at <= path.size();) {
    const size_t end = std::min(path.find('/', at), path.size());
    segments.push_back(path.substr(at, end - at));
    at = end + 1;
  }
  return segments;
}

FileToSend::~FileToSend() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string FileToSend::Read(std::uint64_t offset, std::size_t most) const {
  std::string bytes(most, '\0');
  const ssize_t count = ::pread(descriptor_, bytes.data(), most, static_cast<off_t>(offset));
  bytes.resize(count > 0 ? static_cast<size_t>(count) : 0);
  return bytes;
}

HttpReply ReplyOf(const HttpError& error) {
  HttpReply reply;
  reply.status = error.status;
  const Json json = {{"error", {{"message", error.message}, {"remedy", error.remedy}}}};
  reply.body = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return reply;
}

}  // namespace glint
