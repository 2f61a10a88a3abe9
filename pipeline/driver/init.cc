#include "pipeline/driver/init.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "base/board/board_kind.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/board_file.h"
#include "base/images/image.h"
#include "base/images/image_format.h"
#include "base/photos/photo.h"
#include "base/photos/photo_name.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr double kFrameSquares = 3;     // squares left standing at each side of the default window
constexpr double kSampleMargin_mm = 5;  // between the window's edge and the sample

std::string Lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

// Extensions of photographs (or videos) in a folder, and how many files have each.
std::map<std::string, size_t> CountFiles(const fs::path& folder,
                                         bool (*wanted)(const fs::path& file)) {
  std::map<std::string, size_t> counts;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const bool hidden = entry.path().filename().string()[0] == '.';
    if (hidden || !wanted(entry.path()) || !entry.is_regular_file()) continue;
    ++counts[Lower(entry.path().extension())];
  }
  return counts;
}

// A string in TOML.
std::string TomlQuoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

// ["photos/*.jpg", "photos/*.png"], and the number of files that match. `subfolder` may be empty.
std::string Patterns(const fs::path& folder, const std::string& subfolder,
                     bool (*wanted)(const fs::path& file), size_t* files) {
  *files = 0;
  std::string list;
  for (const auto& [extension, count] : CountFiles(folder / subfolder, wanted)) {
    *files += count;
    const std::string before = subfolder.empty() ? "" : subfolder + "/";
    if (!list.empty()) list += ", ";
    list += TomlQuoted(fmt::format("{}*{}", before, extension));
  }
  return list.empty() ? "" : "[" + list + "]";
}

// A list in TOML; empty where there are none.
std::string NamesIn(const std::string& subfolder, const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    list += (list.empty() ? "" : ", ") + TomlQuoted((fs::path(subfolder) / name).generic_string());
  }
  return list.empty() ? "" : "[" + list + "]";
}

struct Films {
  std::set<std::string>
      live;  // beside photographs of the same names: filmed while those were taken
  std::set<std::string> others;
};

Films FilmsIn(const fs::path& folder) {
  std::set<std::string> stems;
  Films films;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (IsPhotoFileName(entry.path())) stems.insert(entry.path().stem());
  }
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path& file = entry.path();
    if (!IsVideoFileName(file) || file.filename().string()[0] == '.') continue;
    (stems.contains(file.stem()) ? films.live : films.others).insert(file.filename());
  }
  return films;
}

size_t Photographs(const fs::path& folder) {
  size_t count = 0;
  for (const auto& [extension, files] : CountFiles(folder, IsPhotoFileName)) count += files;
  for (const auto& [extension, files] : CountFiles(folder, IsVideoFileName)) count += files;
  return count;
}

// Where the photographs lie: in photos/, or wherever beneath the folder, itself included, most are;
// not what is of the board alone, or ours.
std::string PhotoFolder(const fs::path& folder) {
  if (Photographs(folder / "photos") > 0) return "photos";
  std::string found = "photos";
  size_t most = 0;
  const auto consider = [&](const std::string& subfolder) {
    const size_t count = Photographs(folder / subfolder);
    if (count > most) most = count, found = subfolder;
  };
  consider("");
  std::set<std::string> subfolders;  // in an order that no file system decides
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename();
    if (entry.is_directory() && name[0] != '.' && name != "board" && name != "glint") {
      subfolders.insert(name);
    }
  }
  for (const std::string& subfolder : subfolders) consider(subfolder);
  return found;
}

std::string NumberText(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

std::string List(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + NumberText(number);
  return "[" + text + "]";
}

void RequireCount(const std::vector<double>& numbers, size_t count, const std::string& option,
                  const std::string& what) {
  if (numbers.size() == count) return;
  throw UserError("--" + option + ": found " + std::to_string(numbers.size()) + " numbers; give " +
                  what);
}

void RequireWhole(const std::vector<double>& numbers, const std::string& option) {
  for (const double number : numbers) {
    if (number >= 0 && number <= 1000 && number == std::floor(number)) continue;
    throw UserError("--" + option + ": found " + NumberText(number) +
                    "; give whole numbers from 0 to 1000");
  }
}

Board DescribedBoard(const InitOptions& options, std::vector<double>* window) {
  RequireCount(options.squares, 2, "squares", "COLUMNS,ROWS");
  RequireWhole(options.squares, "squares");
  Board board;
  board.kind = BoardKindNamed(options.board).value();
  board.squares_x = static_cast<int>(options.squares[0]);
  board.squares_y = static_cast<int>(options.squares[1]);
  board.square_mm = options.square_mm;
  board.marker_mm = options.marker_mm;
  board.dictionary = options.dictionary;
  *window = options.window;
  if (window->empty() && !options.full_board) {
    const double columns = options.squares[0] - 2 * kFrameSquares;
    const double rows = std::min(columns, options.squares[1] - 2 * kFrameSquares);
    if (columns < 1 || rows < 1) {
      throw UserError(
          "--squares: found a board too small for a window of its own; give --window, or "
          "--full-board");
    }
    *window = {kFrameSquares, std::floor((options.squares[1] - rows) / 2), columns, rows};
  }
  if (!window->empty()) {
    RequireCount(*window, 4, "window", "FIRST_COLUMN,FIRST_ROW,COLUMNS,ROWS");
    RequireWhole(*window, "window");
    board.window = BoardWindow{static_cast<int>((*window)[0]), static_cast<int>((*window)[1]),
                               static_cast<int>((*window)[2]), static_cast<int>((*window)[3])};
  }
  if (const std::string wrong = CheckBoard(board); !wrong.empty()) {
    throw UserError("board: " + wrong);
  }
  return board;
}

void CheckSampleSize(const std::vector<double>& sample_mm) {
  RequireCount(sample_mm, 2, "sample-mm", "WIDTH,HEIGHT");
  for (const double side : sample_mm) {
    if (side > 0) continue;
    throw UserError("--sample-mm: found " + NumberText(side) + "; give sizes greater than 0");
  }
}

std::vector<double> RoomInBoard_mm(const Board& board) {
  const BoardRectangle room = OpeningInSample(board).value_or(OutlineInSample(board));
  return {std::max(room.right_mm - room.left_mm - 2 * kSampleMargin_mm, 1.0),
          std::max(room.top_mm - room.bottom_mm - 2 * kSampleMargin_mm, 1.0)};
}

// Of the window; none: the sample lies on or beside the board.
std::vector<double> Opening_mm(const Board& board) {
  const auto opening = OpeningInSample(board);
  if (!opening) return {};
  return {opening->right_mm - opening->left_mm, opening->top_mm - opening->bottom_mm};
}

// What lies round the sample, as capture.toml says it, and the size of the sample that goes with
// it.
struct Surroundings {
  std::string text;
  std::vector<double> sample_mm;
  std::string centre_from;      // where centre_mm counts from
  std::vector<double> most_mm;  // what the board leaves room for; empty: unknown
};

std::string BoardPhotosText(const std::string& board_photos) {
  if (board_photos.empty()) {
    return "# photos = [\"board/*.jpg\"]       # more photographs of the board, for the lens "
           "alone\n";
  }
  return "photos = " + board_photos +
         "       # more photographs of the board, for the lens alone\n";
}

// Of a board that glint board has printed, or a person described in the folder's board.json.
std::string BoardFileText(const Board& board, const std::string& board_photos) {
  std::string text = "[board]                          # what lies round the sample\n";
  text += "file = \"board.json\"\n";
  if (board.ruler) {
    text += "# measured_ruler_mm = " + NumberText(board.ruler->length_mm()) +
            "        # the printed ruler, where it has another length\n";
  }
  return text + BoardPhotosText(board_photos);
}

std::string BoardText(const InitOptions& options, const std::vector<double>& window,
                      const std::string& board_photos) {
  std::string text = "[board]                          # what lies round the sample\n";
  text += "kind = \"" + options.board + "\"\n";
  text += "squares = " + List(options.squares) + "               # columns, rows of squares\n";
  text += "square_mm = " + NumberText(options.square_mm) +
          "                  # measure the print: printers scale\n";
  if (options.board == "charuco") {
    text += "marker_mm = " + NumberText(options.marker_mm) + "\n";
    text += "dictionary = \"" + options.dictionary + "\"\n";
  }
  if (window.empty()) {
    text += "# window = [3, 5, 7, 7]          # first column, first row, columns, rows left out\n";
  } else {
    text += "window = " + List(window) +
            "            # first column, first row, columns, rows left out for the sample\n";
  }
  return text + BoardPhotosText(board_photos);
}

Surroundings WithBoard(const InitOptions& options, const std::string& board_photos) {
  std::vector<double> window;
  const fs::path board_file = options.folder / "board.json";
  if (fs::exists(board_file)) {
    const Board board = ReadBoardFile(board_file).board;
    return {BoardFileText(board, board_photos), RoomInBoard_mm(board), "the board's centre",
            Opening_mm(board)};
  }
  const Board board = DescribedBoard(options, &window);
  return {BoardText(options, window, board_photos), RoomInBoard_mm(board), "the board's centre",
          Opening_mm(board)};
}

// COLMAP knows no millimetres and not which part of the plane is meant: a person must say.
Surroundings WithoutBoard() {
  return {
      "[calib]\nposes = \"colmap\"                 # cameras from the photographs alone; or "
      "\"colmap:DIR\", a model\n\n"
      "[poses]                          # one length is needed: photo and corners_px, or "
      "height_mm\n"
      "# photo = \"photos/IMG_0001.jpg\"  # the pixels below are of this photograph\n"
      "# corners_px = [[441, 275], [732, 288], [720, 579], [429, 567]]  # the sample's: top "
      "left, top right, bottom right, bottom left\n"
      "# height_mm = 300                # or the lens's usual height above the sample\n",
      {100, 100},
      "where the photographs look, or [poses] says",
      {}};
}

// The one photograph's file.
fs::path OnlyPhoto(const InitOptions& options) {
  const fs::path folder = options.folder / PhotoFolder(options.folder);
  std::vector<fs::path> photos;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && IsPhotoFileName(entry.path())) photos.push_back(entry.path());
  }
  if (photos.size() == 1) return photos[0];
  throw UserError(folder, "", std::to_string(photos.size()) + " photographs",
                  "--single is for one photograph; for several lay a board round the sample (glint "
                  "board), or let COLMAP find the cameras (--board none)");
}

// The largest square that stays clear of the picture's borders.
Surroundings FromAbove(const InitOptions& options) {
  constexpr double kOfShorterSide = 0.9;
  if ((options.width_mm > 0) == (options.distance_mm > 0)) {
    throw UserError(
        "--single: found neither or both of --width-mm and --distance-mm; give one: how much of "
        "the sample the picture's width shows, or how far the lens was from it");
  }
  const auto [width_px, height_px] = PhotoSize(OnlyPhoto(options));
  if (options.width_mm == 0 && options.sample_mm.empty()) {
    throw UserError("--distance-mm: found no --sample-mm; give the sample's size, WIDTHxHEIGHT");
  }
  const double side_mm =
      std::floor(kOfShorterSide * options.width_mm * std::min(width_px, height_px) / width_px);
  const std::string length = options.width_mm > 0
                                 ? "picture_width_mm = " + NumberText(options.width_mm) +
                                       "           # how much of the sample its width shows\n"
                                 : "height_mm = " + NumberText(options.distance_mm) +
                                       "                  # of the lens above the sample\n";
  return {
      "[calib]\nposes = \"above\"                  # one photograph from straight above, no "
      "board\n\n[poses]\n" +
          length,
      {std::max(1.0, side_mm), std::max(1.0, side_mm)},
      "the picture's middle",
      {}};
}

// The lights' file, from the capture's folder.
std::string LightsName(const InitOptions& options) {
  std::error_code error;
  fs::path file = options.lights;
  if (!fs::exists(file)) file = options.folder / options.lights;
  if (!fs::is_regular_file(file, error)) {
    throw UserError("--lights: found no file " + options.lights.string() +
                    "; give the list of the lights' directions, such as dirs.lp");
  }
  const fs::path inside =
      fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(options.folder));
  if (!inside.empty() && *inside.begin() != "..") return inside.generic_string();
  throw UserError("--lights: found " + options.lights.string() + ", outside of " +
                  options.folder.string() + "; put it into the capture's folder");
}

fs::path AnyPhoto(const InitOptions& options) {
  const fs::path folder = options.folder / PhotoFolder(options.folder);
  std::set<fs::path> photos;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && IsPhotoFileName(entry.path())) photos.insert(entry.path());
  }
  if (!photos.empty()) return *photos.begin();
  throw UserError(folder, "", "no photographs", "put them there first; their size is needed");
}

std::string BallsText(const std::vector<double>& at) {
  std::string text;
  for (size_t i = 0; i + 5 < at.size(); i += 6) {
    std::string ball;
    for (size_t k = i; k < i + 6; k += 2) {
      ball += (k > i ? ", " : "") + List({at[k], at[k + 1]});
    }
    text += (i > 0 ? ", " : "") + ("[" + ball + "]");
  }
  return at.size() > 6 ? "[" + text + "]" : text;
}

// The nominal width of a picture whose scale nobody gave: EXIF knows no millimetres.
constexpr double kAssumedWidth_mm = 100;

// The whole picture, of a camera that stands still.
Surroundings WithFixedCamera(const InitOptions& options, InitResult* result) {
  if (!options.balls_px.empty() && options.balls_px.size() != 6 && options.balls_px.size() != 12) {
    throw UserError(
        "--balls-px: found " + std::to_string(options.balls_px.size()) +
        " numbers; give x,y of three points on the ball's rim, or of six for two balls");
  }
  if (!options.lights.empty() && !options.balls_px.empty()) {
    throw UserError("--lights: found it together with --balls-px; give one of them");
  }
  const auto [width_px, height_px] = PhotoSize(AnyPhoto(options));
  result->size_assumed = options.width_mm == 0 && options.sample_mm.empty();
  const double width_mm = options.width_mm > 0        ? options.width_mm
                          : options.sample_mm.empty() ? kAssumedWidth_mm
                                                      : options.sample_mm[0];
  const double height_mm = std::floor(1e4 * width_mm * height_px / width_px) / 1e4;
  std::string text = "[lights]                         # where the light was in each photograph\n";
  text += options.lights.empty() ? "balls_px = " + BallsText(options.balls_px) +
                                       "  # points on the rim of each reflecting ball\n"
                                 : "file = " + TomlQuoted(LightsName(options)) + "\n";
  text +=
      "# distance_mm = 1000             # of the lights; if omitted, ten times the picture's "
      "longer side\n";
  text += "# camera_mm = 1000               # of the lens above the sample; likewise\n";
  text += "# unit = \"mm\"                  # the file holds positions, not directions\n\n";
  text += "[poses]\npicture_width_mm = " + NumberText(width_mm) +
          "           # how much of the sample its width shows" +
          (result->size_assumed ? ": ASSUMED, correct it" : "") + "\n";
  text +=
      "# photo = \"image00.jpg\"         # or the ends of a ruler in this photograph\n"
      "# points_px = [[100, 200], [900, 210]]\n# points_mm = 50\n";
  return {text, {width_mm, height_mm}, "the picture's middle", {width_mm, height_mm}};
}

// A fixed camera's maps have as many texels as pixels show the sample, up to what most machines can
// take.
int ResolutionOf(const InitOptions& options, double share_of_picture) {
  constexpr int kUsual = 1024, kLeast = 8, kMost = 2048;
  if (options.resolution_px >= kLeast) return options.resolution_px;
  if (options.resolution_px != 0) {
    throw UserError(
        fmt::format("--resolution: found {}; give at least {}", options.resolution_px, kLeast));
  }
  if (!options.fixed_camera()) return kUsual;
  const double width_px = share_of_picture * PhotoSize(AnyPhoto(options)).first;
  return std::clamp(static_cast<int>(std::lround(width_px)), kLeast, kMost);
}

void CheckEncoding(const std::string& encoding) {
  constexpr std::array kNames = {"auto", "srgb", "gamma2.2", "linear"};
  if (std::find(kNames.begin(), kNames.end(), encoding) != kNames.end()) return;
  if (fs::path(encoding).extension() == ".json") return;
  throw UserError(
      "--encoding: found '" + encoding +
      "'; use auto, srgb, gamma2.2, linear or the path of a response-curve file (.json)");
}

std::string PhotoText(const InitOptions& options, size_t* files) {
  size_t videos = 0;
  const std::string subfolder = PhotoFolder(options.folder);
  const std::string patterns = Patterns(options.folder, subfolder, IsPhotoFileName, files);
  const Films films = FilmsIn(options.folder / subfolder);
  std::string video = Patterns(options.folder, subfolder, IsVideoFileName, &videos);
  if (!films.live.empty()) {
    videos = films.others.size();
    video = NamesIn(subfolder, films.others);
  }
  std::string text = "[photos]\n";
  if (!patterns.empty() || video.empty()) {
    text += "files = " + (patterns.empty() ? "[\"photos/*.jpg\"]" : patterns) + "\n";
  }
  if (!video.empty()) {
    text += "video = " + video + "\nevery = " + std::to_string(options.every) +
            "                       # one frame in so many becomes a photograph\n";
  }
  if (!films.live.empty()) {
    const size_t more = films.live.size() - 1;
    text += "# left out: " + *films.live.begin() +
            (more > 0 ? fmt::format(" and {} more", more) : "") +
            "; films of live photographs, which show no flash\n";
  }
  *files += videos;
  return text + "\n";
}

}  // namespace

std::string InitResult::BriefReport() const {
  std::string text = "wrote " + file.string() + " (" + std::to_string(photos) + " photographs";
  if (board_photos > 0) text += ", " + std::to_string(board_photos) + " of the board alone";
  text += ")\n";
  const std::string folder = file.parent_path().string();
  if (photos == 0) {
    text += "put the photographs into " + (file.parent_path() / "photos").string() + "\n";
  }
  text += has_board || single || fixed_camera ? "check the measures in it"
                                              : "say in [poses] how large the sample is";
  if (size_assumed) {
    text += "; the picture's width is taken to show 100 mm: correct size_mm and picture_width_mm";
  }
  return text + ", then: glint run " + folder + "\n";
}

// The folder's name, as far as it can be a file's.
std::string MaterialName(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(folder, error);
  const std::string name = (error ? folder : whole).filename().string();
  return name.empty() || name == "." ? "material" : FileNameOf(name);
}

std::string CaptureText(const InitOptions& options, InitResult* result) {
  RequireCount(options.light_offset_mm, 3, "light-offset-mm", "X,Y,Z");
  CheckEncoding(options.encoding);
  result->has_board = options.board != "none" && !options.single && !options.fixed_camera();
  result->single = options.single;
  result->fixed_camera = options.fixed_camera();
  if (options.single && options.fixed_camera()) {
    throw UserError("--single: found it together with --lights or --balls-px; give one of them");
  }
  std::string board_photos;
  if (result->has_board) {
    board_photos = Patterns(options.folder, "board", IsPhotoFileName, &result->board_photos);
  }
  const Surroundings around = result->has_board        ? WithBoard(options, board_photos)
                              : options.fixed_camera() ? WithFixedCamera(options, result)
                              : options.single         ? FromAbove(options)
                                                       : WithoutBoard();
  if (!options.sample_mm.empty()) CheckSampleSize(options.sample_mm);
  const std::vector<double>& size_mm =
      options.sample_mm.empty() ? around.sample_mm : options.sample_mm;
  for (size_t i = 0; i < around.most_mm.size(); ++i) {
    if (size_mm[i] <= around.most_mm[i]) continue;
    if (options.fixed_camera()) {
      throw UserError("--sample-mm: found " + List(size_mm) + ", while the picture shows " +
                      List(around.most_mm) + "; give a smaller one, or --width-mm");
    }
    throw UserError("--sample-mm: found " + List(size_mm) + ", which the board's window of " +
                    List(around.most_mm) +
                    " is too small to show whole; give only the part that lies in the window, or "
                    "print a board with a "
                    "larger one (glint board --sample-mm)");
  }
  std::string text = "# A capture for Glint; docs/capture.md explains every key.\n\n";
  if (options.fixed_camera()) {
    text += "kind = \"fixed camera\"            # and the light moved; docs/rti.md\n\n";
  }
  text += "[sample]                         # the part of the surface that becomes maps\n";
  text += "size_mm = " + List(size_mm) + "             # width, height\n";
  text += "# centre_mm = [0, 0]             # from " + around.centre_from + ", x right, y up\n";
  const double share = around.most_mm.empty() ? 1 : size_mm[0] / around.most_mm[0];
  const int resolution_px = ResolutionOf(options, share);
  text += "resolution_px = " + std::to_string(resolution_px) +
          "             # width of the maps, or [width, height]\n\n";
  text += PhotoText(options, &result->photos);
  text += around.text + "\n";
  text += "[radiometry]\nencoding = \"" + options.encoding +
          "\"                # auto, srgb, gamma2.2, linear, a curve\n\n";
  text += options.fixed_camera() ? "[light]\n"
                                 : "[light]\noffset_mm = " + List(options.light_offset_mm) +
                                       "           # the flash from the lens: x right, y down, z "
                                       "forward\n";
  text += "# power = 30000                  # radiance times mm^2; if omitted, estimated\n";
  text += "# ambient = [0, 0, 0]\n\n";
  text += "# Options of the stages, as on their command lines (glint help fit):\n";
  text += result->has_board ? "# [calib]\n" : "";
  text += "# [rectify]\n# [fit]\n";
  text += "# metals = \"possible\"            # there may be bare metal: see docs/capture.md\n";
  text += "# [refine]\n# [report]\n";
  text += "[export]\nname = \"" + MaterialName(options.folder) +
          "\"                  # what the files' names begin with\n";
  return text;
}

InitResult WriteCapture(const InitOptions& options) {
  InitResult result;
  result.file = options.folder / "capture.toml";
  if (fs::exists(fs::symlink_status(result.file))) {
    throw UserError(result.file, "", "an existing capture.toml", "edit it, or move it away first");
  }
  std::error_code error;
  if (!options.create && !fs::is_directory(options.folder, error)) {
    throw UserError(options.folder, "", "no such folder",
                    "check its name, or make it with --create");
  }
  const std::string text = CaptureText(options, &result);
  fs::create_directories(options.folder, error);
  if (error) {
    throw EnvironmentError(options.folder.string() + ": cannot create the folder: " +
                           error.message() + "; check the path and its permissions");
  }
  WriteFileAtomically(result.file, text);
  return result;
}

}  // namespace glint
