// Who may come in: what every request is checked for before anything else.
//
//   Host     an address that is served, by number or "localhost": a page of elsewhere whose name is
//            made to lead here (DNS rebinding) names itself there
//   Origin   that of the page itself, where a browser tells it, and always for writes; a write
//   needs
//            the header X-Glint besides, which no form of another site can send
//   cookie   the session's secret, which the address that Studio opens sets
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/studio/http/http_types.h"

namespace glint {

// An address that is served.
struct Door {
  std::vector<std::string> hosts;  // "127.0.0.1", "localhost"; without the port
  int port = 0;
  std::string session;  // the secret of its cookie; empty: only phones come in here
  bool local = false;   // other machines do not reach it
  std::string cookie() const { return "glint_studio_" + std::to_string(port); }
};

// Throws HttpError 421 or 403.
void CheckHostAndOrigin(const Door& door, const HttpRequest& request);

// Of anything but files that are the same for everybody. Throws HttpError 401.
void CheckSession(const Door& door, const HttpRequest& request);

// The reply that sets the cookie and leads to "/"; none where the request has no right secret.
std::optional<HttpReply> OpenSession(const Door& door, const HttpRequest& request);

// Headers for every reply: what the page may load and do (Content-Security-Policy), and that nobody
// keeps or frames it.
void AddSecurityHeaders(HttpReply* reply);
// The same for a report, which has scripts and styles of its own: it runs as a page of nowhere.
void AddReportHeaders(HttpReply* reply);

}  // namespace glint
