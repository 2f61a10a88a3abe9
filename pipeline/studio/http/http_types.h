// Requests and replies as Studio sees them; cpp-httplib stays inside server.cc.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint {

struct HttpRequest {
  std::string method;                          // "GET" …
  std::string path;                            // percent-decoded, without the query
  std::map<std::string, std::string> query;    // decoded
  std::map<std::string, std::string> headers;  // names in lower case; the first of a name
  std::string remote_ip;
  int local_port = 0;

  // "": there is none.
  std::string Header(const std::string& lower_case_name) const;
  std::string Cookie(const std::string& name) const;
  // The path cut at '/': {"api", "captures", "…"}; empty parts are kept, so that "//" matches
  // nothing.
  std::vector<std::string> Segments() const;
};

// A part of a multipart/form-data body.
struct HttpPart {
  std::string field, file_name;  // as the client names the file; never a path here
};

// A body that is read only when asked for, piece by piece.
class HttpBody {
 public:
  virtual ~HttpBody() = default;
  // All of it. Throws HttpError 413 beyond `limit_bytes`.
  virtual std::string Text(std::size_t limit_bytes) = 0;
  // Calls `begin` for each part and `data` for its bytes, until one returns false. Returns whether
  // all came. Throws HttpError 415 where the body is no multipart/form-data.
  virtual bool Parts(const std::function<bool(const HttpPart&)>& begin,
                     const std::function<bool(std::string_view)>& data) = 0;
};

// An open file that is sent and closed.
class FileToSend {
 public:
  FileToSend(int descriptor, std::uint64_t bytes) : descriptor_(descriptor), bytes_(bytes) {}
  ~FileToSend();
  FileToSend(const FileToSend&) = delete;
  FileToSend& operator=(const FileToSend&) = delete;
  std::uint64_t bytes() const { return bytes_; }
  // Bytes from `offset`, at most `most`; empty: an error.
  std::string Read(std::uint64_t offset, std::size_t most) const;

 private:
  int descriptor_;
  std::uint64_t bytes_;
};

struct HttpReply {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
  std::shared_ptr<FileToSend> file;  // in place of `body`
  // In place of `body`: called until it returns false; appends what is to be sent now. Blocks while
  // there is nothing, but not longer than about 15 s.
  std::function<bool(std::string*)> stream;
};

// Thrown by handlers: what a person is told, with the status.
struct HttpError {
  int status = 400;
  std::string message, remedy;
};
// {"error": {"message": …, "remedy": …}}
HttpReply ReplyOf(const HttpError& error);

using HttpHandler = std::function<HttpReply(const HttpRequest&, HttpBody*)>;

}  // namespace glint
