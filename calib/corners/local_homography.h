// Where on the picture a point of the board lies, from points known round it.
//
// A homography fitted to all points, each weighted by its nearness on the board: it follows lens
// distortion where points are dense and degrades to the global homography where they are not.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace glint {

struct PlanePoint {
  Eigen::Vector2d board;  // any unit; squares here
  Eigen::Vector2d image_px;
};

// Least-squares homography (normalised DLT) image ~ H board. nullopt: fewer than four points, or
// points on a line. `weights` empty: all 1.
std::optional<Eigen::Matrix3d> FitHomography(const std::vector<PlanePoint>& points,
                                             const std::vector<double>& weights = {});

// nullopt for a point on or behind the horizon.
std::optional<Eigen::Vector2d> ApplyHomography(const Eigen::Matrix3d& h, const Eigen::Vector2d& p);

// The homography near `at`: weights exp(−d²/2s²) + 1e-3 with s = `reach` (units of the board).
// `skip` leaves one point out (−1: none).
std::optional<Eigen::Matrix3d> LocalHomography(const std::vector<PlanePoint>& points,
                                               const Eigen::Vector2d& at, double reach,
                                               int skip = -1);

}  // namespace glint
