#include "pipeline/studio/routes/board_routes.h"

#include "pipeline/studio/routes/replies.h"
#include "pipeline/studio/routes/request_json.h"

namespace glint {
namespace {

HttpReply ListBoards(const BoardShelf& shelf) {
  Json list = Json::array();
  for (const KeptBoard& board : shelf.List()) list.push_back(ToJson(board));
  return JsonReply({{"boards", list}});
}

HttpReply PrintBoard(BoardShelf* shelf, const Json& json) {
  return JsonReply(ToJson(shelf->Print(TextIn(json, "paper", "A4"), PairIn(json, "window_mm"))));
}

// A board that is printed already: the text of its board.json, or of a capture.toml.
HttpReply DescribeBoard(const BoardShelf& shelf, const Json& json) {
  return JsonReply(
      ToJson(shelf.Describe(TextIn(json, "file_name", ""), TextIn(json, "description", ""))));
}

HttpReply MakeBoard(BoardShelf* shelf, const Json& json) {
  return json.contains("description") ? DescribeBoard(*shelf, json) : PrintBoard(shelf, json);
}

HttpReply MeasureBoard(BoardShelf* shelf, const std::string& id, const Json& json) {
  const double ruler_mm = NumberIn(json, "ruler_measured_mm", 0);
  if (!(ruler_mm > 0)) throw HttpError{422, "found no length", "give the ruler's millimetres"};
  return JsonReply(ToJson(shelf->Measure(id, ruler_mm)));
}

HttpReply SendPdf(const BoardShelf& shelf, const std::string& id) {
  const auto board = shelf.Find(id);
  if (!board) ThrowNotFound();
  HttpReply reply = FileReply(board->folder / "board.pdf", "application/pdf");
  reply.headers.emplace_back("Content-Disposition", "inline; filename=\"board.pdf\"");
  return reply;
}

}  // namespace

HttpReply RouteBoards(const RouteContext& context, const Segments& at, const std::string& method,
                      HttpBody* body) {
  BoardShelf& shelf = context.workspace->boards();
  if (at.size() == 1 && method == "GET") return ListBoards(shelf);
  if (at.size() == 1 && method == "POST") return MakeBoard(&shelf, JsonBody(body));
  if (at.size() == 2 && method == "PUT") return MeasureBoard(&shelf, at[1], JsonBody(body));
  if (at.size() == 3 && method == "GET" && at[2] == "board.pdf") return SendPdf(shelf, at[1]);
  ThrowNotFound();
}

}  // namespace glint
