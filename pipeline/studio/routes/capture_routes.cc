#include "pipeline/studio/routes/capture_routes.h"

#include <cmath>
#include <thread>

#include "base/programs/subprocess.h"
#include "pipeline/studio/routes/phone_routes.h"
#include "pipeline/studio/routes/replies.h"
#include "pipeline/studio/routes/request_json.h"
#include "pipeline/studio/routes/result_routes.h"

namespace glint {
namespace {

HttpReply MakeCaptureFrom(const RouteContext& context, const Json& json) {
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
  const BoardShelf& shelf = context.workspace->boards();
  if (!board.empty()) wanted.board = shelf.Find(board);
  const std::string id = context.workspace->Make(wanted);
  if (wanted.board) (void)shelf.Adopt(*wanted.board);  // a refused capture leaves its id as it is
  return JsonReply({{"id", id}});
}

HttpReply SendCapture(const RouteContext& context, const LibraryEntry& entry) {
  Json json = context.workspace->CaptureJson(entry, AddressOfFiles(context, entry),
                                             "/api/captures/" + entry.id + "/thumbnail/");
  const auto link = context.phones->Of(entry.id);
  json["phone"] = link ? PhoneLinkJson(*link, context.lan()) : Json();
  return JsonReply(json);
}

void OpenFolder(const Door& door, const std::filesystem::path& folder) {
  if (!door.local) throw HttpError{403, "the folder is on another machine", "open it there"};
  // Some desktops' openers end with what they have opened.
  std::thread([folder] {
    try {
      OpenOnDesktop(folder.string());
    } catch (const Error&) {
    }
  }).detach();
}

// POST /api/captures/ID/WHAT
HttpReply Act(const RouteContext& context, const Door& door, const LibraryEntry& entry,
              const std::string& what, HttpBody* body) {
  Workspace& workspace = *context.workspace;
  if (what == "photographs") return JsonReply(workspace.Receive(entry, body));
  if (what == "phone") {
    const Door lan = context.open_lan();
    return JsonReply(PhoneLinkJson(context.phones->Open(entry.id), lan));
  }
  if (what == "trash") {
    workspace.Trash(entry);
  } else if (what == "run") {
    const Json json = JsonBody(body);
    workspace.Run(entry, json.contains("quick") && FlagIn(json, "quick"));
  } else if (what == "cancel") {
    workspace.runs().Cancel(entry.id);
  } else if (what == "open-folder") {
    OpenFolder(door, entry.folder);
  } else {
    ThrowNotFound();
  }
  return JsonReply(Json::object());
}

void ChangeBoardTo(const RouteContext& context, const LibraryEntry& entry, const Json& json) {
  const BoardShelf& shelf = context.workspace->boards();
  const auto board = shelf.Find(TextIn(json, "board", ""));
  if (!board) throw HttpError{404, "there is no such board", "reload the page"};
  context.workspace->SetBoard(entry, {*board, PairIn(json, "size_mm")});
  (void)shelf.Adopt(*board);
}

// PUT /api/captures/ID/options, /board, /photographs/PID
HttpReply Change(const RouteContext& context, const LibraryEntry& entry, const Segments& at,
                 HttpBody* body) {
  if (at.size() == 2 && at[0] == "photographs") {
    context.workspace->SetLeftOut(entry, at[1], FlagIn(JsonBody(body), "left_out"));
    return JsonReply(Json::object());
  }
  if (at.size() != 1) ThrowNotFound();
  if (at[0] == "board") {
    ChangeBoardTo(context, entry, JsonBody(body));
  } else if (at[0] == "options") {
    context.workspace->SetOptions(entry, JsonBody(body));
  } else {
    ThrowNotFound();
  }
  return SendCapture(context, entry);
}

// `at` is what follows the capture's id.
HttpReply RouteOneCapture(const RouteContext& context, const Door& door, const LibraryEntry& entry,
                          const Segments& at, const std::string& method, HttpBody* body) {
  const std::string what = at.empty() ? "" : at[0];
  if (method == "GET" && at.empty()) return SendCapture(context, entry);
  if (method == "GET" && what == "thumbnail" && at.size() <= 2) {
    return SendThumbnail(context, entry, at.size() == 2 ? at[1] : "");
  }
  if (method == "GET" && what == "boards" && at.size() == 1) {
    return JsonReply(context.workspace->BoardsToOfferJson(entry));
  }
  if (method == "PUT") return Change(context, entry, at, body);
  if (method == "DELETE" && what == "phone" && at.size() == 1) {
    context.phones->Close(entry.id);
    return JsonReply(Json::object());
  }
  if (method != "POST" || at.size() != 1) ThrowNotFound();
  return Act(context, door, entry, what, body);
}

}  // namespace

HttpReply RouteCaptures(const RouteContext& context, const Door& door, const Segments& at,
                        const std::string& method, HttpBody* body) {
  if (at.size() == 1 && method == "POST") return MakeCaptureFrom(context, JsonBody(body));
  if (at.size() < 2) ThrowNotFound();
  const LibraryEntry entry = context.workspace->Find(at[1]);
  return RouteOneCapture(context, door, entry, Segments(at.begin() + 2, at.end()), method, body);
}

HttpReply SendThumbnail(const RouteContext& context, const LibraryEntry& entry,
                        const std::string& photo) {
  HttpReply reply = FileReply(context.workspace->Thumbnail(entry, photo), "image/jpeg");
  // The address of a photograph's thumbnail changes with its content.
  if (!photo.empty()) reply.headers.emplace_back("Cache-Control", "private, max-age=31536000");
  return reply;
}

}  // namespace glint
