// The addresses that Studio serves: this machine's own, and one in its network for phones, which
// opens when it is first asked for.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/studio/access/access.h"
#include "pipeline/studio/http/deadline_socket.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/http/server.h"

namespace glint {

struct DoorOptions {
  int port = 0;      // of the local one; 0: any free one
  bool lan = false;  // browsers may come in from the network as well, by a secret of their own
  std::vector<std::string> lan_addresses;  // of this machine; empty: as its interfaces say
  DeadlineOptions deadlines;
};

class Doors {
 public:
  using Handler = std::function<HttpReply(const Door&, const HttpRequest&, HttpBody*)>;

  // Serves from now on.
  Doors(DoorOptions options, Handler handler);
  ~Doors() { Close(); }
  void Close();  // no request is answered after this

  Door Local() { return CopyOf(local_); }
  Door Lan() { return CopyOf(lan_); }
  // Throws HttpError 503 where there is no network.
  Door OpenLan();

 private:
  std::unique_ptr<HttpServer> Serve(const ServerOptions& options, const Door* door);
  Door CopyOf(const Door& door);

  DoorOptions options_;
  Handler handler_;
  std::mutex mutex_;
  Door local_, lan_;
  std::unique_ptr<HttpServer> local_server_, lan_server_;
};

}  // namespace glint
