// The sample's frame in a COLMAP model: plane, origin, axes and millimetres.
//
// The plane holds most of the points that the photographs centre on; its normal points toward the
// cameras. Frame and scale come, in this order, from [poses] of capture.toml, or from the board
// where photographs show it. Without word on them, the origin is where the optical axes meet the
// plane (median), and x goes to the right in the photograph that looks down most steeply.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/camera/camera_model.h"
#include "base/camera/similarity3.h"
#include "base/formats/capture.h"
#include "calib/colmap/plane.h"

namespace glint {

struct SightedCorner {
  int id = 0;
  Eigen::Vector2d position_in_sample_mm;
  Eigen::Vector2d point_px;
};

// A photograph of the model, upright.
struct PosedPhoto {
  std::string name;  // relative to the capture's folder
  Camera camera;
  Rigid3 camera_from_model;
  std::vector<SightedCorner> corners;  // of the board, where its place is known
};

struct ModelPoint {
  Eigen::Vector3d position;
  // How much the photographs centre on it: Σ over its features of exp(−½ (r/w)²), r the distance
  // from the picture's centre and w a quarter of its diagonal.
  double weight = 1;
};

// What a COLMAP model holds of a capture.
struct PosedModel {
  std::filesystem::path source;  // named in errors
  std::vector<PosedPhoto> photos;
  std::vector<ModelPoint> points;

  std::vector<Eigen::Vector3d> CameraCentres() const;  // one a photograph, in the model's frame
};

struct FrameOptions {
  // A point is on the plane within this share of the cameras' distance.
  double plane_tolerance = 0.005;
  double min_share = 0.25;
};

struct SampleFrame {
  Similarity3 sample_from_model;  // millimetres
  PlaneFit plane;                 // in the model's frame; of the points used
  std::string source;             // "corners", "points", "cameras", "height" or "board"
  size_t plane_points = 0;        // points that the plane was sought in
  double plane_rms_mm = 0;
  double fit_rms_mm = 0;  // "corners" and "board": distance from where they should lie
  int board_photos = 0, board_corners = 0;
};

// Throws UserError: no plane, cameras on both of its sides, no scale, or corners that do not fit
// the sample's size.
SampleFrame FindSampleFrame(const Capture& capture, const PosedModel& model,
                            const FrameOptions& options);

}  // namespace glint
