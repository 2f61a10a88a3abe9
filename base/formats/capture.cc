#include "base/formats/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors/errors.h"
#include "base/files/toml_file.h"
#include "base/files/toml_table.h"
#include "base/formats/board_table.h"
#include "base/formats/capture_files.h"
#include "base/photos/photo_name.h"
#include "base/stages/stages.h"
#include "base/text/name_list.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxResolution_px = 16384;

void ReadSample(const fs::path& file, const toml::table& document, Capture* capture) {
  TomlTable table(file, document, "sample");
  const auto size = table.Numbers("size_mm", 2, false, "give [width, height] in millimetres");
  if (size.empty()) table.Missing("size_mm", "give [width, height] of the sample in millimetres");
  if (!(size[0] > 0 && size[1] > 0 && size[0] < 1e5 && size[1] < 1e5)) {
    table.Reject(*document["sample"]["size_mm"].node(), "size_mm",
                 "give a positive width and height in millimetres");
  }
  capture->sample_size_mm = {size[0], size[1]};
  const auto centre = table.Numbers("centre_mm", 2, false, "give [x, y] in millimetres");
  if (!centre.empty()) capture->board.board_centre_in_sample_mm = {-centre[0], -centre[1]};

  const toml::node* height = table.Find("height_mm");
  if (height != nullptr && !(height->is_string() && height->as_string()->get() == "auto")) {
    if (!height->is_number()) {
      table.Reject(*height, "height_mm",
                   "give \"auto\", or by how many millimetres the sample's surface lies above the "
                   "board's (below 0: under it; 0: exactly in its plane)");
    }
    capture->sample_height_mm = table.Number("height_mm", 0, -100, 100, " from -100 to 100");
  }

  const std::string remedy = "give a width in texels, or [width, height], from 8 to 16384";
  const toml::node* node = table.Find("resolution_px");
  if (node == nullptr) {
    capture->resolution_px = {1024, static_cast<int>(std::lround(1024 * size[1] / size[0]))};
  } else if (node->is_integer()) {
    const auto width = node->as_integer()->get();
    if (width < 8 || width > kMaxResolution_px) table.Reject(*node, "resolution_px", remedy);
    capture->resolution_px = {
        static_cast<int>(width),
        static_cast<int>(std::lround(static_cast<double>(width) * size[1] / size[0]))};
  } else {
    const auto pair = table.Integers("resolution_px", 2, false, remedy);
    capture->resolution_px = {pair[0], pair[1]};
  }
  for (const int side : capture->resolution_px) {
    if (side < 8 || side > kMaxResolution_px) {
      throw UserError(file, "sample.resolution_px", std::to_string(side), remedy);
    }
  }
  table.RejectUnknown();
}

void TakeBoard(const fs::path& file, const toml::table& document, Capture* capture) {
  auto table = ReadBoardTable(capture->folder, file, document);
  capture->has_board = table.has_value();
  if (!table) return;
  table->board.board_centre_in_sample_mm = capture->board.board_centre_in_sample_mm;
  capture->board = std::move(table->board);
  capture->board_file = std::move(table->file);
  capture->board_photos = std::move(table->photos);
}

// A sample many times as large as its board, or smaller than a grain of sand beside it, is one of
// them in another unit.
void CheckUnits(const fs::path& file, const Capture& capture) {
  if (!capture.has_board || capture.board.square_mm <= 0) return;
  const BoardRectangle board = OutlineInSample(capture.board);
  const double board_mm = std::max(board.right_mm - board.left_mm, board.top_mm - board.bottom_mm);
  const double sample_mm = std::max(capture.sample_size_mm[0], capture.sample_size_mm[1]);
  constexpr double kMost = 8,
                   kLeast = 1.0 / 200;  // a sample may lie beside a board that gives scale
  if (board_mm <= 0 || sample_mm <= 0) return;
  if (sample_mm > kMost * board_mm) {
    const double in_cm = 10 * capture.board.square_mm, in_m = 1000 * capture.board.square_mm;
    throw UserError(
        file, "board.square_mm",
        fmt::format("{:g}, which makes a board of {:.3g} mm beside a sample of {:g} mm",
                    capture.board.square_mm, board_mm, sample_mm),
        fmt::format("give lengths in millimetres: {:g} centimetres are {:g}, {:g} metres are {:g}",
                    capture.board.square_mm, in_cm, capture.board.square_mm, in_m));
  }
  if (sample_mm < kLeast * board_mm) {
    throw UserError(file, "sample.size_mm",
                    fmt::format("{:g} mm beside a board of {:.3g} mm", sample_mm, board_mm),
                    fmt::format("give lengths in millimetres: {:g} metres are {:g}", sample_mm,
                                1000 * sample_mm));
  }
}

void ReadRadiometry(const fs::path& file, const toml::table& document, Capture* capture) {
  TomlTable radiometry(file, document, "radiometry");
  capture->encoding = radiometry.Text("encoding", "auto");
  if (capture->encoding_is_file()) {
    MatchFiles(capture->folder, capture->encoding, file, "radiometry.encoding");
  } else {
    radiometry.Text("encoding", "auto",
                    {"auto", "srgb", "gamma2.2", "linear", "a response curve's file (.json)"});
  }
  radiometry.RejectUnknown();
  TomlTable light(file, document, "light");
  const auto offset = light.Numbers("offset_mm", 3, false, "give [x, y, z] in millimetres");
  if (!offset.empty()) capture->light_offset_mm = {offset[0], offset[1], offset[2]};
  for (auto [key, target] :
       {std::pair{"power", &capture->light_power}, std::pair{"ambient", &capture->ambient}}) {
    const std::string remedy = "give a number or [r, g, b], none below 0";
    const auto numbers = light.Numbers(key, 3, true, remedy);
    if (numbers.empty()) continue;
    for (const double number : numbers) {
      if (number < 0) light.Reject(*document["light"][key].node(), key, remedy);
    }
    *target = {numbers[0], numbers[1], numbers[2]};
  }
  light.RejectUnknown();
}

// A length and what it is the length of stand together or not at all.
void RequireTogether(const fs::path& file, const std::string& what, bool has_what,
                     const std::string& length, bool has_length) {
  if (has_what == has_length) return;
  throw UserError(file, "poses." + (has_what ? length : what), "no such key",
                  "give " + what + " and " + length + " together");
}

void ReadPoses(const fs::path& file, const toml::table& document, Capture* capture) {
  TomlTable table(file, document, "poses");
  PosesTable& poses = capture->poses;
  const std::string unit = " of millimetres, greater than 0";
  poses.photo = table.Text("photo", "");
  poses.corners_px = table.Points(
      "corners_px", 4,
      "give four points [x, y] of `photo`: the sample's top left, top right, bottom right, bottom "
      "left corner");
  poses.points_px = table.Points("points_px", 2, "give two points [[x, y], [x, y]] of `photo`");
  poses.points_mm = table.Number("points_mm", 0, 1e-3, 1e6, unit);
  poses.cameras = table.Texts("cameras", "give the names of two photographs");
  poses.cameras_mm = table.Number("cameras_mm", 0, 1e-3, 1e6, unit);
  poses.height_mm = table.Number("height_mm", 0, 1e-3, 1e6, unit);
  poses.picture_width_mm = table.Number("picture_width_mm", 0, 1e-3, 1e6, unit);
  poses.origin_px = table.Points("origin_px", 1, "give a point [x, y] of `photo`");
  poses.x_axis_px = table.Points("x_axis_px", 2, "give two points [[x, y], [x, y]] of `photo`");
  table.RejectUnknown();
  RequireTogether(file, "points_px", !poses.points_px.empty(), "points_mm", poses.points_mm > 0);
  RequireTogether(file, "cameras", !poses.cameras.empty(), "cameras_mm", poses.cameras_mm > 0);
  std::vector<std::string> names = poses.cameras;
  if (!poses.photo.empty()) names.push_back(poses.photo);
  for (const std::string& name : names) {
    if (std::find(capture->photos.begin(), capture->photos.end(), name) != capture->photos.end())
      continue;
    throw UserError(file, "poses", "'" + name + "', which is not a photograph of the capture",
                    "give its path from the capture's folder, such as \"photos/IMG_0001.jpg\"");
  }
  const bool points = !poses.corners_px.empty() || !poses.points_px.empty() ||
                      !poses.origin_px.empty() || !poses.x_axis_px.empty();
  if (points && poses.photo.empty()) {
    table.Missing("photo", "name the photograph in which the points lie");
  }
  if (!poses.cameras.empty() && poses.cameras.size() != 2) {
    throw UserError(file, "poses.cameras", std::to_string(poses.cameras.size()) + " names",
                    "give the names of two photographs");
  }
  const int scales = !poses.corners_px.empty() + !poses.points_px.empty() + !poses.cameras.empty() +
                     (poses.height_mm > 0) + (poses.picture_width_mm > 0);
  if (scales > 1) {
    throw UserError(file, "poses", std::to_string(scales) + " lengths",
                    "give one of corners_px, points_px, cameras, height_mm and picture_width_mm");
  }
}

// A key that another kind of chart would take is refused: it would be ignored.
void RequireKind(const TomlTable& table, const toml::table& document, const std::string& key,
                 bool goes_with_kind, const std::string& kinds) {
  if (goes_with_kind) return;
  const toml::node* node = document["chart"][key].node();
  if (node != nullptr) table.Reject(*node, key, "take it out, or use " + kinds);
}

void ReadChart(const fs::path& file, const toml::table& document, Capture* capture) {
  TomlTable table(file, document, "chart");
  if (!table.present()) return;
  ChartTable& chart = capture->chart;
  const std::string photo = table.Text("photo", "");
  if (photo.empty()) table.Missing("photo", "name the photograph that shows the chart");
  const auto photos = MatchFiles(capture->folder, photo, file, "chart.photo");
  if (photos.size() != 1) {
    throw UserError(file, "chart.photo", std::to_string(photos.size()) + " files that match",
                    "name one photograph");
  }
  RequireUtf8(file, "chart.photo", photos[0]);
  chart.photo = photos[0];
  chart.kind = table.Text("kind", chart.kind);
  const std::vector<std::string> found(kFoundCharts.begin(), kFoundCharts.end());
  if (chart.kind_is_file()) {
    MatchFiles(capture->folder, chart.kind, file, "chart.kind");
  } else {
    std::vector<std::string> kinds = found;
    kinds.insert(kinds.end(), {"grey", "a table of patches (.csv)"});
    table.Text("kind", chart.kind, kinds);
  }
  chart.corners_px = table.Points(
      "corners_px", 4,
      "give four points [x, y] of `photo`: top left, top right, bottom right, bottom left of the "
      "rectangle round the chart's patches");
  chart.illuminant = table.Text("illuminant", chart.illuminant, {"D50", "D55", "D65", "A", "E"});
  chart.model = table.Text("model", chart.model, {"linear", "root-polynomial"});
  chart.reflectance = table.Number("reflectance", chart.reflectance, 0.01, 1, " from 0.01 to 1");
  table.RejectUnknown();
  const bool grey = chart.kind == "grey";
  RequireKind(table, document, "illuminant", chart.kind_is_file(), "kind = \"PATCHES.csv\"");
  RequireKind(table, document, "reflectance", grey, "kind = \"grey\"");
  RequireKind(table, document, "model", !grey, "a chart of many colours");
  if (chart.corners_px.empty() && (grey || chart.kind_is_file())) {
    table.Missing("corners_px",
                  "only the kinds " + NameList(found, "and") +
                      " are found in a photograph: give the four corners of the chart, in pixels");
  }
}

void RejectUnknownTables(const fs::path& file, const toml::table& document) {
  static const std::set<std::string, std::less<>> known = [] {
    std::set<std::string, std::less<>> tables = {"sample",     "photos", "poses",  "board",
                                                 "radiometry", "light",  "lights", "chart"};
    for (const StageKind& stage : Stages()) tables.emplace(stage.name);
    return tables;
  }();
  for (const auto& [key, node] : document) {
    if (known.count(std::string(key.str())) > 0 || key.str() == "kind") continue;
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    throw UserError(file, TomlPlace{file, std::string(key.str())}.Field(node), "an unknown key",
                    "use one of the tables: " + list + "; or kind, in front of the first of them");
  }
}

// kind = "fixed camera", in front of the first table.
void ReadKind(const fs::path& file, const toml::table& document, Capture* capture) {
  const toml::node* node = document.get("kind");
  if (node == nullptr) return;
  const std::string kind = node->is_string() ? node->as_string()->get() : "";
  if (kind == "fixed camera") {
    capture->kind = CaptureKind::kFixedCamera;
  } else if (kind != "moved camera") {
    throw UserError(file, TomlPlace{file, "kind"}.Field(*node), DescribeToml(*node),
                    "use \"moved camera\" (the flash is the camera's) or \"fixed camera\" (the "
                    "light moves)");
  }
}

// Three points on the rim of each ball: [[x, y], [x, y], [x, y]], or a list of two of these.
std::vector<double> ReadBalls(TomlTable* table) {
  const std::string remedy =
      "give three points [x, y] on the ball's rim in the upright photographs, or a list of two "
      "such "
      "triples";
  const toml::node* node = table->Find("balls_px");
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr || array->empty()) table->Reject(*node, "balls_px", remedy);
  std::vector<double> numbers;
  const auto add = [&](const toml::node& points) {
    const toml::array* triple = points.as_array();
    if (triple == nullptr || triple->size() != 3) table->Reject(points, "balls_px", remedy);
    for (const toml::node& point : *triple) {
      const toml::array* pair = point.as_array();
      if (pair == nullptr || pair->size() != 2) table->Reject(point, "balls_px", remedy);
      for (const toml::node& element : *pair) {
        if (!element.is_number()) table->Reject(element, "balls_px", remedy);
        numbers.push_back(*element.value<double>());
      }
    }
  };
  const toml::array* first = (*array)[0].as_array();
  const bool one = first != nullptr && !first->empty() && !(*first)[0].is_array();
  if (one) {
    add(*node);
    return numbers;
  }
  if (array->size() > 2) table->Reject(*node, "balls_px", remedy);
  for (const toml::node& ball : *array) add(ball);
  return numbers;
}

void ReadLights(const fs::path& file, const toml::table& document, Capture* capture) {
  TomlTable table(file, document, "lights");
  if (!capture->fixed_camera()) {
    if (!table.present()) return;
    throw UserError(file, "lights", "a table for a camera that stands still",
                    "write kind = \"fixed camera\" in front of the first table, or take it out");
  }
  if (capture->has_board) {
    throw UserError(file, "board", "a board beside kind = \"fixed camera\"",
                    "take one of them out: a camera that stands still needs no board, the scale "
                    "comes from [poses]");
  }
  LightsTable& lights = capture->lights;
  lights.file = table.Text("file", "");
  lights.unit = table.Text("unit", "", {"mm", "cm", "m"});
  const std::string length = " of millimetres, greater than 0";
  lights.distance_mm = table.Number("distance_mm", 0, 1e-3, 1e7, length);
  lights.camera_mm = table.Number("camera_mm", 0, 1e-3, 1e7, length);
  lights.balls_px = ReadBalls(&table);
  table.RejectUnknown();
  if (!lights.file.empty()) MatchFiles(capture->folder, lights.file, file, "lights.file");
  if (lights.file.empty() != lights.balls_px.empty()) return;
  throw UserError(file, "lights",
                  lights.file.empty() ? "neither file nor balls_px" : "both file and balls_px",
                  "give file = \"dirs.lp\", with the direction of each photograph's light, or "
                  "balls_px, where reflecting balls lie in the photographs");
}

}  // namespace

bool ChartTable::kind_is_file() const { return fs::path(kind).extension() == ".csv"; }

bool Capture::encoding_is_file() const { return fs::path(encoding).extension() == ".json"; }

std::string Capture::resolved_encoding() const {
  return encoding_is_file() ? (folder / encoding).string() : encoding;
}

std::vector<fs::path> Capture::FilesBehind(const std::vector<std::string>& names) const {
  std::vector<fs::path> files;
  for (const std::string& name : FilesOfPhotos(names)) files.push_back(folder / name);
  if (encoding_is_file()) files.push_back(folder / encoding);
  return files;
}

Capture ReadCapture(const fs::path& folder, Photographs photographs) {
  Capture capture;
  capture.folder = folder.filename() == "capture.toml" ? folder.parent_path() : folder;
  if (capture.folder.empty()) capture.folder = ".";
  capture.file = capture.folder / "capture.toml";
  if (!fs::is_directory(capture.folder)) {
    throw UserError(capture.folder, "", "no such folder", "give the folder of a capture");
  }
  if (!fs::exists(capture.file)) {
    throw UserError(capture.file, "", "no such file",
                    "write one with: glint init " + capture.folder.string());
  }
  const auto document = ReadTomlFile(capture.file);
  RejectUnknownTables(capture.file, *document);
  ReadSample(capture.file, *document, &capture);
  TomlTable photos(capture.file, *document, "photos");
  capture.photos =
      ReadPhotos(capture.folder, "files", &photos, capture.file, &capture.left_out_photos);
  photos.RejectUnknown();
  TakeBoard(capture.file, *document, &capture);
  CheckUnits(capture.file, capture);
  capture.tiles = document->contains("tile");
  ReadPoses(capture.file, *document, &capture);
  ReadKind(capture.file, *document, &capture);
  ReadLights(capture.file, *document, &capture);
  ReadRadiometry(capture.file, *document, &capture);
  ReadChart(capture.file, *document, &capture);
  const bool required = photographs == Photographs::kRequired;
  if (required && photos.present() && capture.photos.empty()) {
    throw UserError(capture.file, "photos.files", "no photograph that matches",
                    "put photographs into the folder, or correct the pattern");
  }
  return capture;
}

}  // namespace glint
