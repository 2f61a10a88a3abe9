#include "pipeline/studio/doors.h"

#include "pipeline/studio/access/token.h"
#include "pipeline/studio/http/address.h"

namespace glint {

Doors::Doors(DoorOptions options, Handler handler)
    : options_(std::move(options)), handler_(std::move(handler)) {
  local_.hosts = {"127.0.0.1", "localhost"};
  local_.session = RandomToken();
  local_.local = true;
  ServerOptions server;
  server.port = options_.port;
  server.deadlines = options_.deadlines;
  {
    // The handler waits for its door's port.
    const std::lock_guard<std::mutex> guard(mutex_);
    local_server_ = Serve(server, &local_);
    local_.port = local_server_->port();
  }
  if (options_.lan) OpenLan();
}

void Doors::Close() {
  lan_server_.reset();
  local_server_.reset();
}

std::unique_ptr<HttpServer> Doors::Serve(const ServerOptions& options, const Door* door) {
  return std::make_unique<HttpServer>(options,
                                      [this, door](const HttpRequest& request, HttpBody* body) {
                                        return handler_(CopyOf(*door), request, body);
                                      });
}

Door Doors::CopyOf(const Door& door) {
  const std::lock_guard<std::mutex> guard(mutex_);
  return door;
}

Door Doors::OpenLan() {
  // A phone has a few connections at a time; more from one address would be somebody else's.
  constexpr int kMostPerClient = 64;
  const std::lock_guard<std::mutex> guard(mutex_);
  if (lan_server_) return lan_;
  lan_.hosts = options_.lan_addresses.empty() ? LanAddresses() : options_.lan_addresses;
  if (lan_.hosts.empty()) {
    throw HttpError{503, "this machine is on no network that a phone could reach",
                    "connect it to the phone's network"};
  }
  if (options_.lan) lan_.session = RandomToken();
  ServerOptions server;
  server.address = "0.0.0.0";
  server.most_per_client = kMostPerClient;
  server.deadlines = options_.deadlines;
  lan_server_ = Serve(server, &lan_);
  lan_.port = lan_server_->port();
  return lan_;
}

}  // namespace glint
