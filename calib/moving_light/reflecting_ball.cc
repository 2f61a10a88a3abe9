#include "calib/moving_light/reflecting_ball.h"

#include <algorithm>
#include <cmath>

#include "base/statistics/median.h"

namespace glint {
namespace {

// Mirrored light comes from the horizon at r/√2 and from behind the ball farther out, where the
// rim mirrors the table.
constexpr double kOfRadius = 0.72;

}  // namespace

std::optional<BallOutline> CircleThrough(const std::array<Eigen::Vector2d, 3>& points_px) {
  // From the first point: 2 p·c = p·p of the other two.
  const double x1 = points_px[1].x() - points_px[0].x(), y1 = points_px[1].y() - points_px[0].y();
  const double x2 = points_px[2].x() - points_px[0].x(), y2 = points_px[2].y() - points_px[0].y();
  const double square1 = x1 * x1 + y1 * y1, square2 = x2 * x2 + y2 * y2;
  const double twice_area = x1 * y2 - x2 * y1;
  constexpr double kFlat = 1e-3;  // of the triangle's sides
  if (!(std::abs(twice_area) > kFlat * std::max(square1, square2))) return std::nullopt;
  const double x = (square1 * y2 - square2 * y1) / (2 * twice_area);
  const double y = (square2 * x1 - square1 * x2) / (2 * twice_area);
  return BallOutline{{points_px[0].x() + x, points_px[0].y() + y}, std::hypot(x, y)};
}

std::optional<Eigen::Vector3d> LightFromBall(const BallPicture& picture, const BallOutline& ball) {
  std::vector<double> inside;
  float brightest = 0;
  const auto for_each = [&](const auto& f) {
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const double off_x = picture.left_px + x + 0.5 - ball.centre_px.x();
        const double off_y = picture.top_px + y + 0.5 - ball.centre_px.y();
        if (std::hypot(off_x, off_y) > kOfRadius * ball.radius_px) continue;
        f(off_x, off_y, picture.brightness[static_cast<size_t>(y) * picture.width + x]);
      }
    }
  };
  for_each([&](double, double, float value) {
    inside.push_back(value);
    brightest = std::max(brightest, value);
  });
  if (inside.empty()) return std::nullopt;
  const double usual = Median(inside);
  // Half way up from the ball's own brightness: the spot and not the glow about it.
  const double level = usual + 0.5 * (brightest - usual);
  constexpr double kStandsOut = 1.5;
  if (!(brightest > kStandsOut * usual) || !(brightest > 0)) return std::nullopt;
  double sum_x = 0, sum_y = 0, weights = 0;
  for_each([&](double off_x, double off_y, float value) {
    if (value < level) return;
    sum_x += (value - usual) * off_x;
    sum_y += (value - usual) * off_y;
    weights += value - usual;
  });
  const double x = sum_x / weights / ball.radius_px, y = sum_y / weights / ball.radius_px;
  const Eigen::Vector3d normal(x, -y, std::sqrt(std::max(0.0, 1 - x * x - y * y)));
  const Eigen::Vector3d view(0, 0, 1);
  return Eigen::Vector3d(2 * normal.dot(view) * normal - view);
}

}  // namespace glint
