// An HTTP server for one address: a thread for each connection, so that event streams and slow
// clients hold up nobody, and one request for each connection, so that no body can pass for the
// next request.
#pragma once

#include <memory>
#include <string>

#include "pipeline/studio/http/deadline_socket.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {

struct ServerOptions {
  std::string address = "127.0.0.1";
  int port = 0;                 // 0: any free one
  int most_connections = 1000;  // beyond these a new one is closed at once
  int most_per_client = 1000;   // of one address
  DeadlineOptions deadlines;
};

class HttpServer {
 public:
  // Serves from now on. Throws EnvironmentError: the port is taken, or may not be used.
  HttpServer(const ServerOptions& options, HttpHandler handler);
  ~HttpServer();  // ends all connections and waits for their threads
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  int port() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint
