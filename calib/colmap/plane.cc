#include "calib/colmap/plane.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glint {
namespace {

using Eigen::Vector3d;

constexpr size_t kMostScored = 20000;  // points a trial looks at
constexpr int kRefinements = 20;
constexpr double kTukey = 4.685;

// SplitMix64: the same draws on every machine.
class Draws {
 public:
  size_t Below(size_t n) {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return static_cast<size_t>((z ^ (z >> 31)) % n);
  }

 private:
  std::uint64_t state_ = 0x51a7e;
};

// Every k-th point with weight, so that large models cost no more than small ones.
std::vector<CloudPoint> Thinned(const std::vector<CloudPoint>& points) {
  const size_t step = (points.size() + kMostScored - 1) / kMostScored;
  std::vector<CloudPoint> few;
  for (size_t i = 0; i < points.size(); i += std::max<size_t>(step, 1)) {
    if (points[i].weight > 0) few.push_back(points[i]);
  }
  return few;
}

// MSAC: what lies near the plane counts the more the nearer.
double Score(const std::vector<CloudPoint>& points, const PlaneFit& plane, double threshold) {
  double score = 0;
  for (const CloudPoint& point : points) {
    const double share = plane.Distance(point.position) / threshold;
    score += point.weight * std::max(0.0, 1 - share * share);
  }
  return score;
}

bool BestOfTrials(const std::vector<CloudPoint>& points, const PlaneOptions& options,
                  PlaneFit* best) {
  Draws draws;
  double best_score = 0;
  for (int trial = 0; trial < options.trials; ++trial) {
    const Vector3d& a = points[draws.Below(points.size())].position;
    const Vector3d& b = points[draws.Below(points.size())].position;
    const Vector3d& c = points[draws.Below(points.size())].position;
    const Vector3d normal = (b - a).cross(c - a);
    // Three points near a line, or near each other, tell no plane.
    if (!(normal.norm() > 1e-3 * (b - a).norm() * (c - a).norm())) continue;
    PlaneFit plane;
    plane.normal = normal.normalized();
    plane.offset = plane.normal.dot(a);
    const double score = Score(points, plane, options.threshold);
    if (score > best_score) {
      best_score = score;
      *best = plane;
    }
  }
  return best_score > 0;
}

// Weighted least squares of orthogonal distances; returns the eigenvalues of the scatter,
// ascending.
Vector3d LeastSquares(const std::vector<CloudPoint>& points, const std::vector<double>& weights,
                      PlaneFit* plane) {
  double sum = 0;
  Vector3d mean = Vector3d::Zero();
  for (size_t i = 0; i < points.size(); ++i) {
    sum += weights[i];
    mean += weights[i] * points[i].position;
  }
  mean /= sum;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector3d from_mean = points[i].position - mean;
    scatter += weights[i] / sum * from_mean * from_mean.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Vector3d normal = solver.eigenvectors().col(0);
  plane->normal = normal.dot(plane->normal) < 0 ? Vector3d(-normal) : normal;
  plane->offset = plane->normal.dot(mean);
  return solver.eigenvalues();
}

double MedianOffset(const std::vector<CloudPoint>& points, const PlaneFit& plane,
                    double threshold) {
  std::vector<double> offsets;
  for (const CloudPoint& point : points) {
    const double offset = std::abs(plane.Distance(point.position));
    if (offset <= threshold && point.weight > 0) offsets.push_back(offset);
  }
  if (offsets.empty()) return 0;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return *middle;
}

// Returns the eigenvalues of the last scatter.
Vector3d Refine(const std::vector<CloudPoint>& points, double threshold, PlaneFit* plane) {
  Vector3d eigenvalues = Vector3d::Zero();
  std::vector<double> weights(points.size());
  for (int i = 0; i < kRefinements; ++i) {
    const double sigma = 1.4826 * MedianOffset(points, *plane, threshold);
    const double cutoff = std::clamp(kTukey * sigma, 1e-6 * threshold, threshold);
    double sum = 0;
    for (size_t k = 0; k < points.size(); ++k) {
      const double share = plane->Distance(points[k].position) / cutoff;
      const double kept = std::max(0.0, 1 - share * share);
      weights[k] = points[k].weight * kept * kept;
      sum += weights[k];
    }
    if (!(sum > 0)) break;
    eigenvalues = LeastSquares(points, weights, plane);
  }
  return eigenvalues;
}

void Judge(const std::vector<CloudPoint>& points, const PlaneOptions& options, PlaneFit* plane) {
  double all = 0, on = 0, squares = 0;
  for (const CloudPoint& point : points) {
    const double distance = plane->Distance(point.position);
    const bool inlier = point.weight > 0 && std::abs(distance) <= options.threshold;
    plane->inlier.push_back(inlier);
    all += point.weight;
    if (!inlier) continue;
    on += point.weight;
    squares += distance * distance;
    ++plane->inliers;
  }
  plane->share = on / all;
  plane->rms = plane->inliers > 0 ? std::sqrt(squares / plane->inliers) : 0;
}

}  // namespace

PlaneFit FitPlane(const std::vector<CloudPoint>& points, const PlaneOptions& options) {
  PlaneFit plane;
  const std::vector<CloudPoint> few = Thinned(points);
  if (few.size() < std::max<size_t>(options.min_points, 3)) {
    plane.problem = fmt::format("only {} points; at least {} are needed", few.size(),
                                std::max<size_t>(options.min_points, 3));
    return plane;
  }
  if (!BestOfTrials(few, options, &plane)) {
    plane.problem = "all points lie on a line";
    return plane;
  }
  const Vector3d spread = Refine(points, options.threshold, &plane);
  Judge(points, options, &plane);
  if (plane.share < options.min_share || plane.inliers < options.min_points) {
    plane.problem = fmt::format(
        "the points scattered: the best plane contains {} of {} ({:.0f} % by weight; {:.0f} % are "
        "needed)",
        plane.inliers, points.size(), 100 * plane.share, 100 * options.min_share);
  } else if (!(std::sqrt(spread[1]) > options.min_spread * std::sqrt(spread[2]))) {
    plane.problem = "the points along a line, which does not determine a plane";
  }
  return plane;
}

}  // namespace glint
