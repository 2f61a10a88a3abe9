#include "pipeline/studio/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "base/errors/errors.h"
#include "pipeline/studio/access/access.h"
#include "pipeline/studio/access/phone_links.h"
#include "pipeline/studio/access/token.h"
#include "pipeline/studio/doors.h"
#include "pipeline/studio/page/page_files.h"
#include "pipeline/studio/routes/board_routes.h"
#include "pipeline/studio/routes/capture_routes.h"
#include "pipeline/studio/routes/event_stream.h"
#include "pipeline/studio/routes/phone_routes.h"
#include "pipeline/studio/routes/replies.h"
#include "pipeline/studio/routes/result_routes.h"
#include "pipeline/studio/workspace/workspace.h"

namespace glint {
namespace {

int CheckThreads(const StudioOptions& options) {
  if (options.check_threads > 0) return options.check_threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::string AddressWithSecret(const Door& door) {
  return fmt::format("http://{}:{}/?t={}", door.hosts[0], door.port, door.session);
}

// The first page; whoever may not come in reads why as plain text.
HttpReply RootPage(const Door& door, const HttpRequest& request) {
  if (auto opened = OpenSession(door, request)) return *opened;
  try {
    CheckSession(door, request);
  } catch (const HttpError& error) {
    HttpReply reply;
    reply.status = error.status;
    reply.type = "text/plain; charset=utf-8";
    reply.body = "Glint Studio: " + error.message + "; " + error.remedy + ".\n";
    return reply;
  }
  return PageReply("studio.html");
}

bool IsPageFile(const Segments& at) {
  return at.size() == 1 && !at[0].ends_with(".html") && !FindPageFile(at[0]).type.empty();
}

}  // namespace

class Studio::Impl {
 public:
  explicit Impl(const StudioOptions& options)
      : options_(options),
        workspace_(options.folder, CheckThreads(options)),
        phones_(options.phone_idle_s, options.phone_longest_s),
        context_{&workspace_, &phones_, RandomToken(), [this] { return doors_->Lan(); },
                 [this] { return doors_->OpenLan(); }} {
    const DoorOptions doors{options.port, options.lan, options.lan_addresses, options.deadlines};
    doors_.emplace(doors, [this](const Door& door, const HttpRequest& request, HttpBody* body) {
      return Answer(door, request, body);
    });
    if (options.prepare_options) workspace_.options().Prepare();
  }

  ~Impl() {
    workspace_.events().Close();
    doors_->Close();
  }

  int port() { return doors_->Local().port; }
  std::string address() { return AddressWithSecret(doors_->Local()); }
  std::string lan_address() { return options_.lan ? AddressWithSecret(doors_->Lan()) : ""; }

 private:
  HttpReply Answer(const Door& door, const HttpRequest& request, HttpBody* body) {
    HttpReply reply;
    bool is_report = false;
    try {
      CheckHostAndOrigin(door, request);
      reply = Route(door, request, body, &is_report);
    } catch (const HttpError& error) {
      reply = ReplyOf(error);
    } catch (const UserError& error) {
      reply = ReplyOf(ToldWith(422, error));
    } catch (const Error& error) {
      reply = ReplyOf(ToldWith(500, error));
    }
    if (is_report) {
      AddReportHeaders(&reply);
    } else {
      AddSecurityHeaders(&reply);
    }
    return reply;
  }

  HttpReply Route(const Door& door, const HttpRequest& request, HttpBody* body, bool* is_report) {
    const Segments at = request.Segments();
    const bool get = request.method == "GET";
    if (get && IsPageFile(at)) return PageReply(at[0]);  // the same for everybody
    if (at.size() >= 2 && at[0] == "p") return RoutePhone(context_, at, request, body);
    if (door.session.empty()) ThrowNotFound();
    if (get && at.size() >= 3 && at[0] == "files") return RouteResult(context_, at, is_report);
    if (get && request.path == "/") return RootPage(door, request);
    CheckSession(door, request);
    if (at.size() < 2 || at[0] != "api") ThrowNotFound();
    return RouteApi(door, Segments(at.begin() + 1, at.end()), request.method, body);
  }

  HttpReply RouteApi(const Door& door, const Segments& at, const std::string& method,
                     HttpBody* body) {
    const std::string what = at[0];
    if (what == "boards") return RouteBoards(context_, at, method, body);
    if (what == "captures") return RouteCaptures(context_, door, at, method, body);
    if (at.size() != 1 || method != "GET") ThrowNotFound();
    if (what == "studio") return JsonReply(StudioFacts());
    if (what == "library") return JsonReply(workspace_.LibraryJson());
    if (what == "options") return JsonReply(workspace_.options().Form());
    if (what == "events") return EventStream(&workspace_.events(), "", [] { return true; });
    ThrowNotFound();
  }

  Json StudioFacts() {
    Json json = workspace_.StudioJson();
    json["version"] = options_.version;
    json["lan"] = options_.lan;
    return json;
  }

  StudioOptions options_;
  Workspace workspace_;
  PhoneLinks phones_;
  RouteContext context_;
  std::optional<Doors> doors_;  // ends first: it asks the others
};

Studio::Studio(const StudioOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Studio::~Studio() = default;

int Studio::port() const { return impl_->port(); }

std::string Studio::address() const { return impl_->address(); }

std::string Studio::lan_address() const { return impl_->lan_address(); }

}  // namespace glint
