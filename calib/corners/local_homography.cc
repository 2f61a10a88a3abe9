#include "calib/corners/local_homography.h"

#include <Eigen/Dense>
#include <cmath>

namespace glint {
namespace {

struct Normalisation {
  Eigen::Vector2d mean{0, 0};
  double scale = 1;
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
    return m;
  }
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const { return scale * (p - mean); }
};

template <class Get>
Normalisation Normalise(const std::vector<PlanePoint>& points, const std::vector<double>& weights,
                        Get get) {
  Normalisation n;
  double total = 0, spread = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    n.mean += weights[i] * get(points[i]);
    total += weights[i];
  }
  n.mean /= total;
  for (size_t i = 0; i < points.size(); ++i) {
    spread += weights[i] * (get(points[i]) - n.mean).squaredNorm();
  }
  n.scale = spread > 0 ? std::sqrt(2.0 * total / spread) : 1.0;
  return n;
}

}  // namespace

std::optional<Eigen::Matrix3d> FitHomography(const std::vector<PlanePoint>& points,
                                             const std::vector<double>& weights_in) {
  if (points.size() < 4) return std::nullopt;
  const std::vector<double> weights =
      weights_in.empty() ? std::vector<double>(points.size(), 1.0) : weights_in;
  const auto board = Normalise(points, weights, [](const PlanePoint& p) { return p.board; });
  const auto image = Normalise(points, weights, [](const PlanePoint& p) { return p.image_px; });
  // Σ w·(r1·r1ᵀ + r2·r2ᵀ) of the rows r1 = (b, 0, −x·b) and r2 = (0, b, −y·b): blocks of b·bᵀ.
  Eigen::Matrix3d plain = Eigen::Matrix3d::Zero(), by_x = plain, by_y = plain, by_square = plain;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d b = board(points[i].board).homogeneous();
    const Eigen::Vector2d p = image(points[i].image_px);
    const Eigen::Matrix3d outer = weights[i] * b * b.transpose();
    plain += outer;
    by_x += p.x() * outer;
    by_y += p.y() * outer;
    by_square += p.squaredNorm() * outer;
  }
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 9, 9> a;
  a << plain, none, -by_x, none, plain, -by_y, -by_x, -by_y, by_square;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(a);
  // The null space must have one dimension; points on a line leave more.
  if (!(eigen.eigenvalues()[1] > 1e-9 * eigen.eigenvalues()[8])) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> v = eigen.eigenvectors().col(0);
  Eigen::Matrix3d h;
  h << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
  h = image.matrix().inverse() * h * board.matrix();
  // Sign: the points themselves are in front of the horizon.
  double side = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    side += weights[i] * h.row(2).dot(points[i].board.homogeneous());
  }
  return side < 0 ? Eigen::Matrix3d(-h) : h;
}

std::optional<Eigen::Vector2d> ApplyHomography(const Eigen::Matrix3d& h, const Eigen::Vector2d& p) {
  const Eigen::Vector3d q = h * p.homogeneous();
  if (!(q.z() > 1e-12 * h.norm())) return std::nullopt;
  const Eigen::Vector2d image = q.hnormalized();
  if (!image.allFinite()) return std::nullopt;
  return image;
}

std::optional<Eigen::Matrix3d> LocalHomography(const std::vector<PlanePoint>& points,
                                               const Eigen::Vector2d& at, double reach, int skip) {
  constexpr double kFloor = 1e-3;
  std::vector<PlanePoint> used;
  std::vector<double> weights;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (i == skip) continue;
    used.push_back(points[i]);
    const double d2 = (points[i].board - at).squaredNorm();
    weights.push_back(std::exp(-0.5 * d2 / (reach * reach)) + kFloor);
  }
  return FitHomography(used, weights);
}

}  // namespace glint
