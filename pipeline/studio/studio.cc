#include "pipeline/studio/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/errors/errors.h"
#include "pipeline/contract/subprocess.h"
#include "pipeline/studio/access.h"
#include "pipeline/studio/http/address.h"
#include "pipeline/studio/http/server.h"
#include "pipeline/studio/page/page_files.h"
#include "pipeline/studio/phone_links.h"
#include "pipeline/studio/results.h"
#include "pipeline/studio/token.h"
#include "pipeline/studio/workspace.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

using Segments = std::vector<std::string>;

constexpr std::size_t kMostJson_bytes = 1 << 20;
constexpr double kEventPatience_s = 15;
// A phone has a few connections at a time; more from one address would be somebody else's.
constexpr int kMostPerLanClient = 64;

HttpReply JsonReply(const Json& json) {
  HttpReply reply;
  reply.body = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return reply;
}

[[noreturn]] void ThrowNotFound() {
  throw HttpError{404, "there is nothing at this address", "use the links of the page"};
}

HttpReply FileReply(const fs::path& file, const std::string& type) {
  HttpReply reply;
  reply.file = OpenToSend(file);
  if (!reply.file) ThrowNotFound();
  reply.type = type;
  return reply;
}

HttpReply PageReply(const std::string& name) {
  const PageFile file = FindPageFile(name);
  if (file.type.empty()) ThrowNotFound();
  HttpReply reply;
  if (file.bytes.empty()) {
    reply.status = 503;
    reply.type = "text/plain; charset=utf-8";
    reply.body =
        "This build of Glint has no pages for Studio: install node and npm, let them reach the npm "
        "registry once, and build again.\n";
    return reply;
  }
  reply.type = file.type;
  reply.body = std::string(file.bytes);
  return reply;
}

Json JsonBody(HttpBody* body) {
  const std::string text = body->Text(kMostJson_bytes);
  const Json json = Json::parse(text.empty() ? "{}" : text, nullptr, false);
  if (!json.is_object()) throw HttpError{400, "found no JSON object", "reload the page"};
  return json;
}

double NumberIn(const Json& json, const std::string& key, double fallback) {
  if (!json.contains(key) || json[key].is_null()) return fallback;
  if (!json[key].is_number()) {
    throw HttpError{422, key + ": found " + json[key].dump(), "give a number"};
  }
  return json[key].get<double>();
}

std::string TextIn(const Json& json, const std::string& key, const std::string& fallback) {
  if (!json.contains(key) || json[key].is_null()) return fallback;
  if (!json[key].is_string()) {
    throw HttpError{422, key + ": found " + json[key].dump(), "give a text"};
  }
  return json[key].get<std::string>();
}

std::optional<std::array<double, 2>> PairIn(const Json& json, const std::string& key) {
  if (!json.contains(key) || json[key].is_null()) return std::nullopt;
  const Json& pair = json[key];
  if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number()) {
    throw HttpError{422, key + ": found " + pair.dump(), "give width and height"};
  }
  return std::array{pair[0].get<double>(), pair[1].get<double>()};
}

bool FlagIn(const Json& json, const std::string& key) {
  if (!json.contains(key) || !json[key].is_boolean()) {
    throw HttpError{422, key + ": found no flag", "give true or false"};
  }
  return json[key].get<bool>();
}

}  // namespace

class Studio::Impl {
 public:
  explicit Impl(const StudioOptions& options)
      : options_(options),
        workspace_(options.folder, CheckThreads(options)),
        phones_(options.phone_idle_s, options.phone_longest_s),
        files_secret_(RandomToken()) {
    local_.hosts = {"127.0.0.1", "localhost"};
    local_.session = RandomToken();
    local_.local = true;
    ServerOptions server;
    server.port = options.port;
    server.deadlines = options.deadlines;
    // The handler waits for its door's port.
    const std::lock_guard<std::mutex> guard(doors_);
    local_server_ =
        std::make_unique<HttpServer>(server, [this](const HttpRequest& request, HttpBody* body) {
          return Answer(DoorOf(&local_), request, body);
        });
    local_.port = local_server_->port();
    if (options.lan) OpenLan();
    if (options.prepare_options) workspace_.PrepareOptions();
  }

  ~Impl() {
    workspace_.events().Close();
    lan_server_.reset();
    local_server_.reset();
  }

  int port() const { return local_.port; }
  std::string address() const {
    return fmt::format("http://127.0.0.1:{}/?t={}", local_.port, local_.session);
  }
  std::string lan_address() const {
    if (!options_.lan) return "";
    return fmt::format("http://{}:{}/?t={}", lan_.hosts[0], lan_.port, lan_.session);
  }

 private:
  static int CheckThreads(const StudioOptions& options) {
    if (options.check_threads > 0) return options.check_threads;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }

  Door DoorOf(const Door* door) {
    const std::lock_guard<std::mutex> guard(doors_);
    return *door;
  }

  // Under `doors_`. For phones alone, unless --lan lets browsers in as well.
  void OpenLan() {
    if (lan_server_) return;
    lan_.hosts = options_.lan_addresses.empty() ? LanAddresses() : options_.lan_addresses;
    if (lan_.hosts.empty()) {
      throw HttpError{503, "this machine is in no network that a phone could reach",
                      "connect it to the network of the phone"};
    }
    if (options_.lan) lan_.session = RandomToken();
    ServerOptions server;
    server.address = "0.0.0.0";
    server.most_per_client = kMostPerLanClient;
    server.deadlines = options_.deadlines;
    lan_server_ =
        std::make_unique<HttpServer>(server, [this](const HttpRequest& request, HttpBody* body) {
          return Answer(DoorOf(&lan_), request, body);
        });
    lan_.port = lan_server_->port();
  }

  HttpReply Answer(const Door& door, const HttpRequest& request, HttpBody* body) {
    HttpReply reply;
    bool is_report = false;
    try {
      CheckHostAndOrigin(door, request);
      reply = Route(door, request, body, &is_report);
    } catch (const HttpError& error) {
      reply = ReplyOf(error);
    } catch (const UserError& error) {
      reply = ReplyOf(Told(422, error));
    } catch (const Error& error) {
      reply = ReplyOf(Told(500, error));
    }
    if (is_report) {
      AddReportHeaders(&reply);
    } else {
      AddSecurityHeaders(&reply);
    }
    return reply;
  }

  static HttpError Told(int status, const Error& error) {
    const std::string text = error.what();
    const size_t cut = text.rfind("; ");
    if (cut == std::string::npos) return {status, text, ""};
    return {status, text.substr(0, cut), text.substr(cut + 2)};
  }

  HttpReply Route(const Door& door, const HttpRequest& request, HttpBody* body, bool* is_report) {
    const Segments at = request.Segments();
    const bool get = request.method == "GET";
    if (at.size() == 1 && get && !at[0].ends_with(".html") && !FindPageFile(at[0]).type.empty()) {
      return PageReply(at[0]);  // the same for everybody
    }
    if (at.size() >= 2 && at[0] == "p") return RoutePhone(at, request, body);
    if (door.session.empty()) ThrowNotFound();
    if (at.size() >= 3 && at[0] == "files" && get) return SendResult(at, is_report);
    if (get && request.path == "/") {
      if (auto opened = OpenSession(door, request)) return *opened;
      return RootPage(door, request);
    }
    CheckSession(door, request);
    if (at.empty() || at[0] != "api") ThrowNotFound();
    return RouteApi(door, Segments(at.begin() + 1, at.end()), request, body);
  }

  static HttpReply RootPage(const Door& door, const HttpRequest& request) {
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

  HttpReply RouteApi(const Door& door, const Segments& at, const HttpRequest& request,
                     HttpBody* body) {
    const std::string& method = request.method;
    const std::string what = at.empty() ? "" : at[0];
    if (at.size() == 1 && method == "GET") {
      if (what == "studio") return JsonReply(StudioFacts());
      if (what == "library") return JsonReply(workspace_.LibraryJson());
      if (what == "options") return JsonReply(workspace_.Options());
      if (what == "events") return Events("", "");
    }
    if (what == "boards") return RouteBoards(at, method, body);
    if (what != "captures") ThrowNotFound();
    if (at.size() == 1 && method == "POST") return MakeCaptureFrom(JsonBody(body));
    if (at.size() < 2) ThrowNotFound();
    return RouteCapture(door, workspace_.Find(at[1]), Segments(at.begin() + 2, at.end()), method,
                        body);
  }

  Json StudioFacts() {
    Json json = workspace_.StudioJson();
    json["version"] = options_.version;
    json["lan"] = options_.lan;
    return json;
  }

  HttpReply RouteBoards(const Segments& at, const std::string& method, HttpBody* body) {
    BoardShelf& shelf = workspace_.boards();
    if (at.size() == 1 && method == "GET") {
      Json list = Json::array();
      for (const KeptBoard& board : shelf.List()) list.push_back(ToJson(board));
      return JsonReply({{"boards", list}});
    }
    if (at.size() == 1 && method == "POST") {
      const Json json = JsonBody(body);
      return JsonReply(ToJson(shelf.Print(TextIn(json, "paper", "A4"), PairIn(json, "window_mm"))));
    }
    if (at.size() == 2 && method == "PUT") {
      const double ruler_mm = NumberIn(JsonBody(body), "ruler_measured_mm", 0);
      if (!(ruler_mm > 0)) throw HttpError{422, "found no length", "give the ruler's millimetres"};
      return JsonReply(ToJson(shelf.Measure(at[1], ruler_mm)));
    }
    if (at.size() == 3 && method == "GET" && at[2] == "board.pdf") {
      const auto board = shelf.Find(at[1]);
      if (!board) ThrowNotFound();
      HttpReply reply = FileReply(board->folder / "board.pdf", "application/pdf");
      reply.headers.emplace_back("Content-Disposition", "inline; filename=\"board.pdf\"");
      return reply;
    }
    ThrowNotFound();
  }

  HttpReply MakeCaptureFrom(const Json& json) {
    NewCapture wanted;
    wanted.name = TextIn(json, "name", "");
    wanted.kind = TextIn(json, "kind", "board");
    wanted.size_mm = PairIn(json, "size_mm");
    if (json.contains("height_mm") && json["height_mm"].is_number()) {
      wanted.height_mm = json["height_mm"].get<double>();
    }
    wanted.picture_width_mm = NumberIn(json, "picture_width_mm", 0);
    wanted.distance_mm = NumberIn(json, "distance_mm", 0);
    const std::string board = TextIn(json, "board", "");
    if (!board.empty()) wanted.board = workspace_.boards().Find(board);
    return JsonReply({{"id", workspace_.Make(wanted)}});
  }

  HttpReply RouteCapture(const Door& door, const LibraryEntry& entry, const Segments& at,
                         const std::string& method, HttpBody* body) {
    const std::string what = at.empty() ? "" : at[0];
    if (at.empty() && method == "GET") return JsonReply(CaptureFacts(entry));
    if (what == "thumbnail" && at.size() <= 2 && method == "GET") {
      return SendThumbnail(entry, at.size() == 2 ? at[1] : "");
    }
    if (what == "photographs" && at.size() == 1 && method == "POST") {
      return JsonReply(workspace_.Receive(entry, body));
    }
    if (what == "photographs" && at.size() == 2 && method == "PUT") {
      workspace_.SetLeftOut(entry, at[1], FlagIn(JsonBody(body), "left_out"));
      return JsonReply(Json::object());
    }
    if (at.size() != 1) ThrowNotFound();
    if (what == "phone" && method == "DELETE") {
      phones_.Close(entry.id);
      return JsonReply(Json::object());
    }
    if (what == "options" && method == "PUT") {
      workspace_.SetOptions(entry, JsonBody(body));
      return JsonReply(CaptureFacts(entry));
    }
    if (method != "POST") ThrowNotFound();
    return Act(door, entry, what, body);
  }

  HttpReply Act(const Door& door, const LibraryEntry& entry, const std::string& what,
                HttpBody* body) {
    if (what == "phone") return JsonReply(OpenPhone(entry));
    if (what == "trash") {
      workspace_.Trash(entry);
    } else if (what == "run") {
      const Json json = JsonBody(body);
      workspace_.Run(entry, json.contains("quick") && FlagIn(json, "quick"));
    } else if (what == "cancel") {
      workspace_.runs().Cancel(entry.id);
    } else if (what == "open-folder") {
      if (!door.local) throw HttpError{403, "the folder is on another machine", "open it there"};
      OpenFolder(entry.folder);
    } else {
      ThrowNotFound();
    }
    return JsonReply(Json::object());
  }

  static void OpenFolder(const fs::path& folder) {
    // Some desktops' openers end with what they have opened.
    std::thread([folder] {
      try {
        OpenOnDesktop(folder.string());
      } catch (const Error&) {
      }
    }).detach();
  }

  std::string FilesOf(const LibraryEntry& entry) const {
    return "/files/" + files_secret_ + "/" + entry.id + "/";
  }

  Json CaptureFacts(const LibraryEntry& entry) {
    Json json =
        workspace_.CaptureJson(entry, FilesOf(entry), "/api/captures/" + entry.id + "/thumbnail/");
    const auto link = phones_.Of(entry.id);
    json["phone"] = link ? PhoneFacts(*link) : Json();
    return json;
  }

  HttpReply SendThumbnail(const LibraryEntry& entry, const std::string& photo) {
    HttpReply reply = FileReply(workspace_.Thumbnail(entry, photo), "image/jpeg");
    // The address of a photograph's thumbnail changes with its content.
    if (!photo.empty()) reply.headers.emplace_back("Cache-Control", "private, max-age=31536000");
    return reply;
  }

  // /files/SECRET/ID/NAME: the report runs as a page of nowhere, which has no cookie.
  HttpReply SendResult(const Segments& at, bool* is_report) {
    if (at.size() < 4 || !SameSecret(files_secret_, at[1])) ThrowNotFound();
    const LibraryEntry entry = workspace_.Find(at[2]);
    std::string name = at[3];
    for (size_t i = 4; i < at.size(); ++i) name += "/" + at[i];
    HttpReply reply;
    if (name == "export.zip") {
      reply.file = ZipOfExport(entry.folder);
      reply.type = "application/zip";
      reply.headers.emplace_back("Content-Disposition",
                                 "attachment; filename=\"" + FileNameOf(entry.name) + ".zip\"");
      return reply;
    }
    const auto files = ResultFiles(entry.folder);
    const auto found = files.find(name);
    if (found == files.end()) ThrowNotFound();
    *is_report = name.ends_with(".html");
    return FileReply(found->second, TypeOfFile(name));
  }

  HttpReply Events(const std::string& only, const std::string& phone) {
    HttpReply reply;
    reply.type = "text/event-stream";
    auto seen = std::make_shared<std::uint64_t>(workspace_.events().Now());
    auto begun = std::make_shared<bool>(false);
    reply.stream = [this, only, phone, seen, begun](std::string* text) {
      if (!*begun) {
        *begun = true;
        *text = "retry: 1000\n\n";
        return true;
      }
      if (!phone.empty() && !phones_.IsValid(phone)) return false;
      return workspace_.events().Next(seen.get(), only, kEventPatience_s, text);
    };
    return reply;
  }

  Json PhoneFacts(const PhoneLink& link) {
    const Door lan = DoorOf(&lan_);
    const std::string url = fmt::format("http://{}:{}/p/{}", lan.hosts[0], lan.port, link.token);
    return {{"url", url}, {"qr_svg", QrSvg(url)}, {"expires_s", std::floor(link.expires_s)}};
  }

  Json OpenPhone(const LibraryEntry& entry) {
    {
      const std::lock_guard<std::mutex> guard(doors_);
      OpenLan();
    }
    return PhoneFacts(phones_.Open(entry.id));
  }

  // /p/TOKEN, /p/TOKEN/state …: one capture, and nothing else of it than its photographs.
  HttpReply RoutePhone(const Segments& at, const HttpRequest& request, HttpBody* body) {
    const auto link = phones_.Use(at[1], request.remote_ip);
    if (!link) {
      if (at.size() == 2 && request.method == "GET") {
        HttpReply page = PageReply("phone.html");  // which says that a new code is needed
        if (page.status == 200) page.status = 410;
        return page;
      }
      throw HttpError{410, "this link has expired, or another phone has opened it",
                      "scan a new code from Studio"};
    }
    if (at.size() == 2 && request.method == "GET") return PageReply("phone.html");
    const LibraryEntry entry = workspace_.Find(link->capture);
    const std::string base = "/p/" + link->token + "/thumbnail/";
    if (at.size() == 3 && request.method == "GET" && at[2] == "state") {
      Json json = workspace_.PhoneJson(entry, base);
      json["expires_s"] = std::floor(link->expires_s);
      return JsonReply(json);
    }
    if (at.size() == 3 && request.method == "GET" && at[2] == "events") {
      return Events(entry.id, link->token);
    }
    if (at.size() == 3 && request.method == "POST" && at[2] == "photographs") {
      return JsonReply(workspace_.Receive(entry, body));
    }
    if (at.size() == 4 && request.method == "GET" && at[2] == "thumbnail") {
      return SendThumbnail(entry, at[3]);
    }
    ThrowNotFound();
  }

  StudioOptions options_;
  Workspace workspace_;
  PhoneLinks phones_;
  std::string files_secret_;
  std::mutex doors_;
  Door local_, lan_;
  std::unique_ptr<HttpServer> local_server_, lan_server_;
};

Studio::Studio(const StudioOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Studio::~Studio() = default;

int Studio::port() const { return impl_->port(); }

std::string Studio::address() const { return impl_->address(); }

std::string Studio::lan_address() const { return impl_->lan_address(); }

}  // namespace glint
