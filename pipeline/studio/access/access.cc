#include "pipeline/studio/access/access.h"

#include <algorithm>

#include "pipeline/studio/access/token.h"

namespace glint {
namespace {

constexpr char kPagePolicy[] =
    "default-src 'self'; img-src 'self' blob: data:; frame-src 'self'; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'self'";
constexpr char kReportPolicy[] =
    "sandbox allow-scripts allow-downloads allow-popups; default-src 'none'; script-src "
    "'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' blob: data:; connect-src data: "
    "blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

bool IsServed(const Door& door, const std::string& host) {
  return std::any_of(door.hosts.begin(), door.hosts.end(), [&](const std::string& one) {
    return host == one + ":" + std::to_string(door.port);
  });
}

void AddCommonHeaders(HttpReply* reply) {
  reply->headers.emplace_back("X-Content-Type-Options", "nosniff");
  reply->headers.emplace_back("Referrer-Policy", "no-referrer");
  reply->headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  const bool has_own = std::any_of(reply->headers.begin(), reply->headers.end(),
                                   [](const auto& one) { return one.first == "Cache-Control"; });
  if (!has_own) reply->headers.emplace_back("Cache-Control", "no-store");
}

}  // namespace

void CheckHostAndOrigin(const Door& door, const HttpRequest& request) {
  if (!IsServed(door, request.Header("host"))) {
    throw HttpError{421, "this address is not one of Studio's",
                    "open the address that glint studio printed"};
  }
  const std::string origin = request.Header("origin");
  const bool write = request.method != "GET";
  const bool own = origin.starts_with("http://") && IsServed(door, origin.substr(7));
  // Reads come without an origin from the page itself; a sandboxed report has "null".
  if (write ? !own : !(origin.empty() || own)) {
    throw HttpError{403, "the request comes from another page",
                    "use Studio's own page, at the address that glint studio printed"};
  }
  const std::string site = request.Header("sec-fetch-site");
  if (write && !site.empty() && site != "same-origin") {
    throw HttpError{403, "the request comes from another site", "use Studio's own page"};
  }
  if (write && request.Header("x-glint") != "1") {
    throw HttpError{403, "the request lacks the header X-Glint", "use Studio's own page"};
  }
}

void CheckSession(const Door& door, const HttpRequest& request) {
  if (SameSecret(door.session, request.Cookie(door.cookie()))) return;
  throw HttpError{401, "this browser has not been granted access",
                  "open the whole address that glint studio printed, or start it again"};
}

std::optional<HttpReply> OpenSession(const Door& door, const HttpRequest& request) {
  const auto given = request.query.find("t");
  if (given == request.query.end() || !SameSecret(door.session, given->second)) return std::nullopt;
  HttpReply reply;
  reply.status = 303;
  reply.type = "text/plain";
  reply.headers = {
      {"Location", "/"},
      {"Set-Cookie", door.cookie() + "=" + door.session + "; Path=/; HttpOnly; SameSite=Strict"}};
  return reply;
}

void AddSecurityHeaders(HttpReply* reply) {
  reply->headers.emplace_back("Content-Security-Policy", kPagePolicy);
  reply->headers.emplace_back("X-Frame-Options", "SAMEORIGIN");
  AddCommonHeaders(reply);
}

void AddReportHeaders(HttpReply* reply) {
  reply->headers.emplace_back("Content-Security-Policy", kReportPolicy);
  AddCommonHeaders(reply);
}

}  // namespace glint
