#include "pipeline/studio/routes/phone_routes.h"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/studio/routes/capture_routes.h"
#include "pipeline/studio/routes/event_stream.h"
#include "pipeline/studio/routes/replies.h"

namespace glint {
namespace {

HttpReply SayExpired(bool page_is_asked_for) {
  if (!page_is_asked_for) {
    throw HttpError{410, "this link has expired, or another phone has opened it",
                    "scan a new code from Studio"};
  }
  HttpReply page = PageReply("phone.html");  // which says that a new code is needed
  if (page.status == 200) page.status = 410;
  return page;
}

HttpReply SendState(const RouteContext& context, const PhoneLink& link, const LibraryEntry& entry) {
  Json json = context.workspace->PhoneJson(entry, "/p/" + link.token + "/thumbnail/");
  json["expires_s"] = std::floor(link.expires_s);
  return JsonReply(json);
}

}  // namespace

HttpReply RoutePhone(const RouteContext& context, const Segments& at, const HttpRequest& request,
                     HttpBody* body) {
  const bool get = request.method == "GET";
  const bool page = get && at.size() == 2;
  const auto link = context.phones->Use(at[1], request.remote_ip);
  if (!link) return SayExpired(page);
  if (page) return PageReply("phone.html");
  const LibraryEntry entry = context.workspace->Find(link->capture);
  if (get && at.size() == 4 && at[2] == "thumbnail") return SendThumbnail(context, entry, at[3]);
  if (at.size() != 3) ThrowNotFound();
  if (get && at[2] == "state") return SendState(context, *link, entry);
  if (get && at[2] == "events") {
    PhoneLinks* const phones = context.phones;
    return EventStream(&context.workspace->events(), entry.id,
                       [phones, token = link->token] { return phones->IsValid(token); });
  }
  if (request.method == "POST" && at[2] == "photographs") {
    return JsonReply(context.workspace->Receive(entry, body));
  }
  ThrowNotFound();
}

Json PhoneLinkJson(const PhoneLink& link, const Door& lan) {
  const std::string url = fmt::format("http://{}:{}/p/{}", lan.hosts[0], lan.port, link.token);
  return {{"url", url}, {"qr_svg", QrSvg(url)}, {"expires_s", std::floor(link.expires_s)}};
}

}  // namespace glint
