// Photographs of drawn charts by cameras of known colours, for the tests of calib/chart.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/photos/photo.h"
#include "calib/chart/chart.h"
#include "calib/chart/find_chart.h"
#include "calib/chart/measure_chart.h"

namespace glint::testing {

struct NamedMatrix {
  std::string name;
  Eigen::Matrix3d matrix;
};
// Camera's linear values of XYZ, as DNG files of cameras give them.
std::vector<NamedMatrix> CameraMatrices();

struct NamedWhite {
  std::string name;
  Eigen::Vector3d xyz;
};
// Daylight, a phone's LED of 4000 K, tungsten.
std::vector<NamedWhite> FlashWhites();

// What the camera makes of linear Rec.709 reflectance under a flash of this white: the surface's
// colour adapted to the flash, the camera's matrix, and a white balance that takes out four fifths
// (in the logarithm) of the white's cast and puts its brightest channel at 1.
Eigen::Matrix3d CameraFromRec709(const Eigen::Matrix3d& camera_from_xyz,
                                 const Eigen::Vector3d& flash_white);

struct ChartShot {
  int width = 1200, height = 900;
  // Of the patches' rectangle.
  ChartCorners corners_px = {{{190, 150}, {1020, 190}, {985, 745}, {165, 700}}};
  Eigen::Matrix3d camera = Eigen::Matrix3d::Identity();  // linear values of Rec.709 reflectance
  double white = 0.9;                     // of a white surface in the middle, brightest channel
  Eigen::Vector3d flash{0.2, -0.1, 1.6};  // place, in half diagonals of the chart
  double noise = 0.004;                   // standard deviation at 1, as shot noise
  int bits = 8;                           // gamma 2.2; 32: linear floats
  unsigned seed = 1;
};

// The chart on a dark card on a grey table.
Photo PhotographOf(const Chart& chart, const ChartShot& shot);

// How the flash lights a point of the chart, 1 in the middle.
double FlashAt(const ChartShot& shot, const Eigen::Vector2d& from_middle);

}  // namespace glint::testing
