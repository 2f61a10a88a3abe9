#include "pipeline/studio/http/server.h"

#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "base/errors/errors.h"

namespace glint {
namespace {

constexpr std::size_t kMostTarget_bytes = 2048;
constexpr int kBacklog = 512;
constexpr std::size_t kPiece_bytes = 256 << 10;

// A DeadlineSocket for cpp-httplib. Functions of later versions are there too, hence no `override`.
class HttplibStream final : public httplib::Stream {
 public:
  HttplibStream(DeadlineSocket* socket, std::string ip, int port, int local_port)
      : socket_(socket), ip_(std::move(ip)), port_(port), local_port_(local_port) {}
  // NOLINTBEGIN(modernize-use-override)
  bool is_readable() const { return socket_->Readable(); }
  bool wait_readable() const { return socket_->Readable(); }
  bool is_writable() const { return socket_->Writable(); }
  bool wait_writable() const { return socket_->Writable(); }
  ssize_t read(char* bytes, size_t most) {
    return static_cast<ssize_t>(socket_->Read(bytes, most));
  }
  ssize_t write(const char* bytes, size_t count) {
    return static_cast<ssize_t>(socket_->Write(bytes, count));
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const {
    ip = ip_;
    port = port_;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const {
    ip.clear();
    port = local_port_;
  }
  socket_t socket() const { return socket_->descriptor(); }
  time_t duration() const { return 0; }
  // NOLINTEND(modernize-use-override)

 private:
  DeadlineSocket* socket_;
  std::string ip_;
  int port_, local_port_;
};

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

HttpRequest RequestOf(const httplib::Request& from, int local_port) {
  HttpRequest request;
  request.method = from.method == "HEAD" ? "GET" : from.method;
  request.path = from.path;
  for (const auto& [name, value] : from.params) request.query.emplace(name, value);
  for (const auto& [name, value] : from.headers) request.headers.emplace(LowerCase(name), value);
  request.remote_ip = from.remote_addr;
  request.local_port = local_port;
  return request;
}

class NoBody final : public HttpBody {
 public:
  std::string Text(std::size_t) override { return ""; }
  bool Parts(const std::function<bool(const HttpPart&)>&,
             const std::function<bool(std::string_view)>&) override {
    throw HttpError{415, "found no body", "send the photographs as multipart/form-data"};
  }
};

class ReadBody final : public HttpBody {
 public:
  ReadBody(const httplib::Request& request, const httplib::ContentReader& reader)
      : request_(request), reader_(reader) {}

  std::string Text(std::size_t limit_bytes) override {
    if (request_.is_multipart_form_data()) throw HttpError{415, "found a form", "send JSON"};
    std::string text;
    bool too_long = false;
    const bool all = reader_([&](const char* bytes, size_t count) {
      too_long = text.size() + count > limit_bytes;
      if (!too_long) text.append(bytes, count);
      return !too_long;
    });
    if (too_long) throw HttpError{413, "the request is too long", "send less"};
    if (!all) throw HttpError{400, "the request ended early", "try again"};
    return text;
  }

  bool Parts(const std::function<bool(const HttpPart&)>& begin,
             const std::function<bool(std::string_view)>& data) override {
    if (!request_.is_multipart_form_data()) {
      throw HttpError{415, "found a request without files", "send them as multipart/form-data"};
    }
    return reader_(
        [&](const httplib::MultipartFormData& part) {
          return begin({part.name, part.filename});
        },
        [&](const char* bytes, size_t count) {
          return data({bytes, count});
        });
  }

 private:
  const httplib::Request& request_;
  const httplib::ContentReader& reader_;
};

void SendFile(const std::shared_ptr<FileToSend>& file, const std::string& type,
              httplib::Response* to) {
  to->set_content_provider(static_cast<size_t>(file->bytes()), type,
                           [file](size_t offset, size_t length, httplib::DataSink& sink) {
                             const std::string piece =
                                 file->Read(offset, std::min(length, kPiece_bytes));
                             return !piece.empty() && sink.write(piece.data(), piece.size());
                           });
}

void SendStream(const std::function<bool(std::string*)>& next, const std::string& type,
                httplib::Response* to) {
  to->set_content_provider(type, [next](size_t, httplib::DataSink& sink) {
    std::string piece;
    const bool more = next(&piece);
    if (!piece.empty() && !sink.write(piece.data(), piece.size())) return false;
    if (!more) sink.done();
    return true;
  });
}

void Fill(const HttpReply& reply, httplib::Response* to) {
  to->status = reply.status;
  for (const auto& [name, value] : reply.headers) to->set_header(name, value);
  if (reply.stream) {
    SendStream(reply.stream, reply.type, to);
  } else if (reply.file && reply.file->bytes() > 0) {
    SendFile(reply.file, reply.type, to);
  } else {
    to->set_content(reply.body, reply.type);
  }
}

HttpReply Answer(const HttpHandler& handler, const HttpRequest& request, HttpBody* body) {
  try {
    return handler(request, body);
  } catch (const HttpError& error) {
    return ReplyOf(error);
  } catch (const UserError& error) {
    return ReplyOf({422, error.what(), ""});
  } catch (const EnvironmentError& error) {
    return ReplyOf({500, error.what(), "look at the folder, its permissions and the free space"});
  } catch (const std::exception& error) {
    return ReplyOf({500, error.what(), "try again; if it persists, report it as a bug in Glint"});
  }
}

}  // namespace

class HttpServer::Impl : private httplib::Server {
 public:
  Impl(const ServerOptions& options, HttpHandler handler)
      : options_(options), handler_(std::move(handler)) {
    Listen();
    svr_sock_ = listening_;  // cpp-httplib stops sending where it has no socket of its own
    Route();
    acceptor_ = std::thread([this] { Accept(); });
  }

  ~Impl() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(stop_, &one, sizeof one);
    acceptor_.join();
    svr_sock_ = INVALID_SOCKET;
    {
      std::unique_lock<std::mutex> guard(mutex_);
      for (const int socket : open_) ::shutdown(socket, SHUT_RDWR);
      ended_.wait(guard, [&] { return open_.empty(); });
    }
    ::close(listening_);
    ::close(stop_);
  }

  int port() const { return port_; }

 private:
  void Listen() {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    stop_ = ::eventfd(0, EFD_CLOEXEC);
    const int yes = 1;
    ::setsockopt(listening_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(options_.port));
    ::inet_pton(AF_INET, options_.address.c_str(), &address.sin_addr);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listening_, generic, size) != 0 || ::listen(listening_, kBacklog) != 0) {
      const std::string why = std::strerror(errno);
      ::close(listening_);
      ::close(stop_);
      throw EnvironmentError(options_.address + ":" + std::to_string(options_.port) +
                             ": cannot be served: " + why + "; give another --port, or 0 for any");
    }
    ::getsockname(listening_, generic, &size);
    port_ = ntohs(address.sin_port);
  }

  // Requests without a body are answered before cpp-httplib routes anything; the others' handlers
  // read theirs piece by piece.
  void Route() {
    set_pre_routing_handler([this](const httplib::Request& from, httplib::Response& to) {
      const bool with_body = from.method == "POST" || from.method == "PUT";
      if (from.target.size() > kMostTarget_bytes) {
        Fill(ReplyOf({414, "the address is too long", "use the links of the page"}), &to);
        return HandlerResponse::Handled;
      }
      if (with_body) return HandlerResponse::Unhandled;
      if (from.method != "GET" && from.method != "HEAD" && from.method != "DELETE") {
        Fill(ReplyOf({405, "found the method " + from.method, "use the page"}), &to);
        return HandlerResponse::Handled;
      }
      NoBody none;
      Fill(Answer(handler_, RequestOf(from, port_), &none), &to);
      return HandlerResponse::Handled;
    });
    const HandlerWithContentReader read = [this](const httplib::Request& from,
                                                 httplib::Response& to,
                                                 const httplib::ContentReader& reader) {
      ReadBody body(from, reader);
      Fill(Answer(handler_, RequestOf(from, port_), &body), &to);
    };
    Post(".*", read);
    Put(".*", read);
  }

  void Accept() {
    for (;;) {
      pollfd wait[2] = {{listening_, POLLIN, 0}, {stop_, POLLIN, 0}};
      if (::poll(wait, 2, -1) < 0 && errno != EINTR) return;
      if (wait[1].revents != 0) return;
      if (wait[0].revents == 0) continue;
      sockaddr_in client{};
      socklen_t size = sizeof client;
      const int socket =
          ::accept4(listening_, reinterpret_cast<sockaddr*>(&client), &size, SOCK_CLOEXEC);
      if (socket < 0) {
        // Out of descriptors, say: others will end.
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        continue;
      }
      Begin(socket, client);
    }
  }

  void Begin(int socket, const sockaddr_in& client) {
    char ip[INET_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET, &client.sin_addr, ip, sizeof ip);
    const int yes = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      if (static_cast<int>(open_.size()) >= options_.most_connections ||
          clients_[ip] >= options_.most_per_client) {
        ::close(socket);
        return;
      }
      open_.insert(socket);
      ++clients_[ip];
    }
    try {
      std::thread([this, socket, ip = std::string(ip), port = ntohs(client.sin_port)] {
        DeadlineSocket connection(socket, options_.deadlines);
        Serve(&connection, ip, port);
        End(socket, ip);  // while the number is still this connection's
      }).detach();
    } catch (const std::system_error&) {  // no thread to be had
      End(socket, ip);
      ::close(socket);
    }
  }

  void End(int socket, const std::string& ip) {
    const std::lock_guard<std::mutex> guard(mutex_);
    open_.erase(socket);
    if (--clients_[ip] <= 0) clients_.erase(ip);
    ended_.notify_all();
  }

  void Serve(DeadlineSocket* socket, const std::string& ip, int port) {
    HttplibStream stream(socket, ip, port, port_);
    bool closed = false;
    if (Process(this, &stream, ip, port, &closed, [&](httplib::Request& request) {
          request.remote_addr = ip;
          request.ranges.clear();  // files are sent whole
          socket->HeadIsRead();
        })) {
      socket->Linger();
    }
  }

  // cpp-httplib 0.11 (Debian 12), or 0.18 (Debian 13), which is told the addresses.
  template <class Self>
  static bool Process(Self* self, httplib::Stream* stream, const std::string& ip, int port,
                      bool* closed, const std::function<void(httplib::Request&)>& on_head) {
    if constexpr (requires {
                    self->process_request(*stream, ip, port, ip, port, true, *closed, on_head);
                  }) {
      return self->process_request(*stream, ip, port, ip, self->port_, true, *closed, on_head);
    } else {
      return self->process_request(*stream, true, *closed, on_head);
    }
  }

  ServerOptions options_;
  HttpHandler handler_;
  int listening_ = -1, stop_ = -1, port_ = 0;
  std::thread acceptor_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::set<int> open_;
  std::map<std::string, int> clients_;
};

HttpServer::HttpServer(const ServerOptions& options, HttpHandler handler)
    : impl_(std::make_unique<Impl>(options, std::move(handler))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port(); }

}  // namespace glint
