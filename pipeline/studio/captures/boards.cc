#include "pipeline/studio/captures/boards.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/programs/subprocess.h"
#include "pipeline/driver/programs.h"
#include "pipeline/studio/captures/capture_boards.h"
#include "pipeline/studio/captures/program_message.h"
#include "pipeline/studio/http/http_types.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

void RunBoardProgram(const std::vector<std::string>& arguments, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path log = folder / "board.log";
  fs::remove(log, error);
  std::vector<std::string> command = {RequireGlintProgram("glint-board").string(), folder.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  if (RunInGroup(command, log, {}) == 0) {
    fs::remove(log, error);
    return;
  }
  const ProgramMessage said = MessageIn(ReadTextFile(log));
  fs::remove(log, error);
  fs::remove(folder, error);  // where nothing is in it
  throw HttpError{422, said.message, said.remedy};
}

std::string PaperOf(const BoardFile& file) {
  if (!file.sheet) return "";
  const double width = file.sheet->width_mm, height = file.sheet->height_mm;
  struct Paper {
    const char* name;
    double width_mm, height_mm;
  };
  constexpr Paper kPapers[] = {
      {"A5", 148, 210},         {"A4", 210, 297},        {"A3", 297, 420},         {"A2", 420, 594},
      {"Letter", 215.9, 279.4}, {"Legal", 215.9, 355.6}, {"Tabloid", 279.4, 431.8}};
  for (const Paper& paper : kPapers) {
    const double narrow = std::min(width, height), wide = std::max(width, height);
    if (std::abs(narrow - paper.width_mm) < 1 && std::abs(wide - paper.height_mm) < 1) {
      return paper.name;
    }
  }
  return fmt::format("{:.0f} × {:.0f} mm", width, height);
}

KeptBoard BoardIn(const fs::path& folder) {
  return {IdOf(folder.filename().string()), folder.filename().string(), folder,
          ReadBoardFile(folder / "board.json")};
}

bool HasPdf(const KeptBoard& board) {
  std::error_code error;
  return fs::is_regular_file(board.folder / "board.pdf", error);
}

}  // namespace

std::string BoardText(const KeptBoard& board) {
  const fs::path file = board.folder / "board.json";
  std::error_code error;
  if (fs::is_regular_file(file, error)) return ReadTextFile(file);
  return ToJson(board.file).dump(2) + "\n";
}

std::vector<KeptBoard> BoardShelf::List() const {
  std::vector<KeptBoard> boards = Printed();
  for (KeptBoard& board : BoardsOfCaptures(captures_(), boards)) boards.push_back(std::move(board));
  return boards;
}

std::vector<KeptBoard> BoardShelf::Printed() const {
  std::vector<KeptBoard> boards;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    if (entry.is_symlink(error) || !entry.is_directory(error)) continue;
    try {
      boards.push_back(BoardIn(entry.path()));
    } catch (const Error&) {
    }
  }
  std::sort(boards.begin(), boards.end(),
            [](const KeptBoard& a, const KeptBoard& b) { return a.name < b.name; });
  return boards;
}

std::optional<KeptBoard> BoardShelf::Find(const std::string& id) const {
  for (const KeptBoard& board : List()) {
    if (board.id == id) return board;
  }
  return std::nullopt;
}

std::optional<std::string> BoardShelf::BoardOf(const fs::path& capture) const {
  std::error_code error;
  const fs::path own = capture / "board.json";
  if (!fs::is_regular_file(own, error)) return std::nullopt;
  const std::string text = ReadTextFile(own);
  for (const KeptBoard& board : Printed()) {
    if (HasPdf(board) && BoardText(board) == text) return board.id;
  }
  return std::nullopt;
}

KeptBoard BoardShelf::Print(const std::string& paper,
                            const std::optional<std::array<double, 2>>& window_mm) {
  std::vector<std::string> arguments = {"--paper=" + paper};
  std::string name = FileNameOf(paper);
  if (window_mm) {
    arguments.push_back(fmt::format("--sample-mm={:g},{:g}", (*window_mm)[0], (*window_mm)[1]));
    name += fmt::format("-{:g}x{:g}", (*window_mm)[0], (*window_mm)[1]);
  }
  std::error_code error;
  if (!fs::exists(folder_ / name / "board.json", error)) {
    RunBoardProgram(arguments, folder_ / name);
  }
  return BoardIn(folder_ / name);
}

KeptBoard BoardShelf::Adopt(const KeptBoard& board) const {
  const std::string name = FileNameOf(board.name);
  fs::path folder = folder_ / name;
  std::error_code error;
  for (int n = 2; fs::exists(folder, error); ++n) folder = folder_ / fmt::format("{}-{}", name, n);
  fs::create_directories(folder);
  WriteFileAtomically(folder / "board.json", BoardText(board));
  if (HasPdf(board)) fs::copy_file(board.folder / "board.pdf", folder / "board.pdf", error);
  return BoardIn(folder);
}

std::optional<KeptBoard> BoardShelf::Take(const std::string& id) const {
  std::optional<KeptBoard> board = Find(id);
  if (!board || board->folder.parent_path() == folder_) return board;
  return Adopt(*board);
}

KeptBoard BoardShelf::Measure(const std::string& id, double ruler_mm) {
  const auto board = Take(id);
  if (!board) throw HttpError{404, "there is no such board", "reload the page"};
  RunBoardProgram({fmt::format("--measured={:.6g}", ruler_mm)}, board->folder);
  return BoardIn(board->folder);
}

std::optional<std::array<double, 2>> WindowOf(const Board& board) {
  const auto opening = OpeningInSample(board);
  if (!opening) return std::nullopt;
  return std::array{opening->right_mm - opening->left_mm, opening->top_mm - opening->bottom_mm};
}

Json ToJson(const KeptBoard& kept) {
  const Board& board = kept.file.board;
  Json json = {{"id", kept.id},
               {"name", kept.name},
               {"paper", PaperOf(kept.file)},
               {"squares", {board.squares_x, board.squares_y}},
               {"square_mm", board.square_mm},
               {"window_mm", nullptr},
               {"ruler_mm", nullptr},
               {"print_scale", board.print_scale},
               {"pdf", HasPdf(kept)}};
  if (const auto window = WindowOf(board)) json["window_mm"] = *window;
  if (board.ruler) json["ruler_mm"] = board.ruler->length_mm();
  return json;
}

}  // namespace glint
