// capture.toml: a capture as its owner describes it. docs/capture.md lists every key.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/board/board.h"

namespace glint {

// [poses]: where the sample lies in a COLMAP model, and how large it is. Points are pixels of the
// upright photograph `photo`; of corners, points, cameras and height at most one is given.
struct PosesTable {
  std::string photo;                 // relative to the folder, one of [photos]
  std::vector<double> corners_px;    // x y of the sample's corners: top left, top right, bottom
                                     // right, bottom left
  std::vector<double> points_px;     // x y of two points of the sample's plane …
  double points_mm = 0;              // … and their distance
  std::vector<std::string> cameras;  // two photographs …
  double cameras_mm = 0;             // … and the distance of the lens between them
  double picture_width_mm = 0;    // of the sample's plane, shown by the one photograph from above
  double height_mm = 0;           // of the lens above the sample in `photo` (none: median of all)
  std::vector<double> origin_px;  // x y of the sample's centre
  std::vector<double> x_axis_px;  // x y of two points, from left to right along the sample
};

// [lights]: where the light stood in each photograph of a camera that stood still.
struct LightsTable {
  std::string file;  // relative to the folder: .lp, .relight or .dome (calib/moving_light)
  // The unit of positions in an .lp file: "mm", "cm" or "m"; empty: it holds directions.
  std::string unit;
  double distance_mm = 0;  // of lights that are known by their direction; 0: not known
  double camera_mm = 0;    // of the lens above the sample; 0: far
  // x y of three points on the rim of each reflecting ball, in the upright photographs; in place of
  // a file.
  std::vector<double> balls_px;
};

// What moves from photograph to photograph.
enum class CaptureKind { kMovedCamera, kFixedCamera };

// Charts that are found in a photograph: the rows of calib/chart/chart_kinds.cc.
inline constexpr std::array<const char*, 3> kFoundCharts = {"classic24", "sg140", "vinyl18"};

// [chart]: a colour chart or grey card in a photograph, by which colours are corrected.
struct ChartTable {
  std::string photo;               // relative to the folder; empty: there is no table
  std::string kind = "classic24";  // of kFoundCharts, "grey", or a table of patches (….csv)
  std::vector<double> corners_px;  // x y of the upright photograph: top left, top right, bottom
                                   // right, bottom left of the patches' rectangle; empty: find it
  std::string illuminant = "D50";  // to which a table's colours are relative
  std::string model = "linear";    // or root-polynomial, see colour_correction.h
  double reflectance = 0.18;       // of a grey card
  bool present() const { return !photo.empty(); }
  bool kind_is_file() const;
};

struct Capture {
  std::filesystem::path folder;  // as given
  std::filesystem::path file;    // folder / "capture.toml"

  // [photos] files: patterns relative to the folder; found files, sorted, relative to the folder.
  // Then the frames of [photos] video, one in `every`: "clip.mp4#0030" (see photo_name.h).
  std::vector<std::string> photos;
  // [photos] left_out: those among the files that are not used at all.
  std::vector<std::string> left_out_photos;
  // [board] photos: more photographs of the board, for the intrinsics alone.
  std::vector<std::string> board_photos;

  bool has_board = false;  // an imported set has none
  std::string
      board_file;  // [board] file, relative to the folder; empty: the table itself describes
  Board board;     // [board]; board_centre_in_sample_mm from [sample] centre_mm

  PosesTable poses;
  ChartTable chart;

  CaptureKind kind = CaptureKind::kMovedCamera;  // kind = "moved camera" or "fixed camera"
  LightsTable lights;                            // of a fixed camera

  std::array<double, 2> sample_size_mm{0, 0};  // [sample] size_mm = [width, height]
  // [sample] height_mm: of the sample's surface above the board's; nullopt: "auto", to be found.
  std::optional<double> sample_height_mm;
  std::array<int, 2> resolution_px{0, 0};  // [sample] resolution_px = width, or [width, height]

  // [radiometry] encoding: auto, srgb, gamma2.2, linear, or a response curve's file (.json),
  // relative to the folder.
  std::string encoding = "auto";
  std::array<double, 3> light_offset_mm{0, 0, 0};  // [light] offset_mm, in the camera frame
  std::array<double, 3> light_power{0, 0, 0};      // [light] power, radiance·mm²; zeros: estimate
  std::array<double, 3> ambient{0, 0, 0};          // [light] ambient

  bool tiles = false;  // there is a table [tile]: maps are made to repeat before export

  // Rectified by another program: nothing to calibrate or rectify.
  bool imported() const { return !has_board && photos.empty(); }
  bool fixed_camera() const { return kind == CaptureKind::kFixedCamera; }
  std::filesystem::path work() const { return folder / "glint"; }
  bool encoding_is_file() const;
  // The encoding as programs resolve it: the folder stands before the name of a file.
  std::string resolved_encoding() const;
  // Files behind the names of photographs, and the response curve where there is one: what a stage
  // that reads these photographs depends on.
  std::vector<std::filesystem::path> FilesBehind(const std::vector<std::string>& names) const;
};

// Reads and checks the file; the stage tables [calib] … [report] are left to OptionSet::LoadToml.
// `folder` may also be the path of the capture.toml itself. Throws UserError, also where [photos]
// matches no photograph, unless there may be none yet.
enum class Photographs { kRequired, kMayBeMissing };
Capture ReadCapture(const std::filesystem::path& folder,
                    Photographs photographs = Photographs::kRequired);

}  // namespace glint
