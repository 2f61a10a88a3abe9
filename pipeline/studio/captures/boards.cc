#include "pipeline/studio/captures/boards.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/programs/subprocess.h"
#include "pipeline/driver/programs.h"
#include "pipeline/studio/captures/capture_boards.h"
#include "pipeline/studio/captures/given_board.h"
#include "pipeline/studio/captures/known_boards.h"
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
  return !board.folder.empty() && fs::is_regular_file(board.folder / "board.pdf", error);
}

}  // namespace

std::string BoardText(const KeptBoard& board) {
  const fs::path file = board.folder / "board.json";
  std::error_code error;
  if (!board.folder.empty() && fs::is_regular_file(file, error)) return ReadTextFile(file);
  return ToJson(board.file).dump(2) + "\n";
}

std::vector<KeptBoard> BoardShelf::List() const {
  std::vector<KeptBoard> boards = Kept();
  for (KeptBoard& board : BoardsOfCaptures(captures_(), boards)) boards.push_back(std::move(board));
  for (KeptBoard& board : KnownBoards(boards)) boards.push_back(std::move(board));
  return boards;
}

std::vector<KeptBoard> BoardShelf::Kept() const {
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

std::optional<KeptBoard> BoardShelf::Same(const Board& board) const {
  const std::string description = DescriptionOf(board);
  for (const KeptBoard& kept : Kept()) {
    if (DescriptionOf(kept.file.board) == description) return kept;
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

KeptBoard BoardShelf::Keep(const std::string& name, const std::string& text) const {
  constexpr size_t kMost = 100;
  const std::string plain = FileNameOf(name).substr(0, kMost);
  fs::path folder = folder_ / plain;
  std::error_code error;
  for (int n = 2; fs::exists(folder, error); ++n) folder = folder_ / fmt::format("{}-{}", plain, n);
  fs::create_directories(folder, error);
  WriteFileAtomically(folder / "board.json", text);
  return BoardIn(folder);
}

KeptBoard BoardShelf::Describe(const std::string& file_name, const std::string& text) const {
  const GivenBoard given = ReadGivenBoard(file_name, text, folder_.parent_path());
  if (const auto same = Same(given.file.board)) return *same;
  return Keep(given.name, given.text);
}

KeptBoard BoardShelf::Adopt(const KeptBoard& board) const {
  if (board.folder.parent_path() == folder_) return board;
  if (const auto same = Same(board.file.board)) return *same;
  KeptBoard kept = Keep(board.name, BoardText(board));
  std::error_code error;
  if (HasPdf(board)) fs::copy_file(board.folder / "board.pdf", kept.folder / "board.pdf", error);
  return kept;
}

KeptBoard BoardShelf::Measure(const std::string& id, double ruler_mm) {
  const auto board = Find(id);
  if (!board) throw HttpError{404, "there is no such board", "reload the page"};
  const fs::path folder = Adopt(*board).folder;
  RunBoardProgram({fmt::format("--measured={:.6g}", ruler_mm)}, folder);
  return BoardIn(folder);
}

std::optional<std::array<double, 2>> WindowOf(const Board& board) {
  const auto opening = OpeningInSample(board);
  if (!opening) return std::nullopt;
  return std::array{opening->right_mm - opening->left_mm, opening->top_mm - opening->bottom_mm};
}

void RequireSampleSize(const std::array<double, 2>& sample_mm) {
  constexpr double kLeast_mm = 1, kMost_mm = 10000;
  for (const double side : sample_mm) {
    if (side >= kLeast_mm && side <= kMost_mm) continue;
    throw HttpError{422, fmt::format("the sample's size: found {:g} mm", side),
                    "give width and height in millimetres"};
  }
}

void RequireRoomFor(const std::array<double, 2>& sample_mm, const Board& board) {
  constexpr double kTolerance_mm = 0.05;
  const auto window = WindowOf(board);
  if (!window) return;
  if (sample_mm[0] <= (*window)[0] + kTolerance_mm &&
      sample_mm[1] <= (*window)[1] + kTolerance_mm) {
    return;
  }
  throw HttpError{422,
                  fmt::format("the sample of {:g} × {:g} mm is larger than the board's window of "
                              "{:g} × {:g} mm",
                              sample_mm[0], sample_mm[1], (*window)[0], (*window)[1]),
                  "give only the part that lies in the window, or print a board with a larger one"};
}

std::string DescriptionOf(const Board& board) {
  return ToJson(BoardFile{board, std::nullopt}).dump();
}

Json ToJson(const KeptBoard& kept) {
  const Board& board = kept.file.board;
  Json json = {{"id", kept.id},
               {"name", kept.name},
               {"words", BoardInWords(board)},
               {"paper", PaperOf(kept.file)},
               {"squares", {board.squares_x, board.squares_y}},
               {"square_mm", board.square_mm},
               {"window_mm", nullptr},
               {"ruler_mm", nullptr},
               {"print_scale", board.print_scale},
               {"pdf", HasPdf(kept)},
               {"known", kept.folder.empty()}};
  if (const auto window = WindowOf(board)) json["window_mm"] = *window;
  if (board.ruler) json["ruler_mm"] = board.ruler->length_mm();
  return json;
}

}  // namespace glint
