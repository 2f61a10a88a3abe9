#include "calib/guidance/polar_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr double kWidth = 420, kHeight = 452, kCentreX = 210, kCentreY = 212, kRadius = 178;

struct Disc {
  double full_deg;  // tilt at the rim

  double Radius(double tilt_deg) const { return kRadius * std::min(tilt_deg / full_deg, 1.0); }
  Eigen::Vector2d At(const Direction& d) const {
    const double a = d.azimuth_deg * kDegree, r = Radius(d.tilt_deg);
    return {kCentreX + r * std::cos(a), kCentreY - r * std::sin(a)};
  }
};

double FullTilt_deg(const Verdict& verdict) {
  double largest = 40;
  for (const ViewFacts& view : verdict.views) {
    largest = std::max({largest, view.camera.tilt_deg, view.light.tilt_deg});
  }
  return std::min(90.0, 10 * std::ceil(largest / 10));
}

std::string Text(double x, double y, const std::string& text, const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, more, text);
}

std::string Rings(const Disc& disc, const GuidanceLimits& limits) {
  std::string svg;
  for (double tilt = disc.full_deg; tilt >= 10; tilt -= 10) {
    svg +=
        fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.1f}\" fill=\"none\" stroke=\"#d0d5dd\"/>\n",
                    kCentreX, kCentreY, disc.Radius(tilt));
  }
  svg += fmt::format(
      "<circle cx=\"{}\" cy=\"{}\" r=\"{:.1f}\" fill=\"#fef0c7\" stroke=\"#f0c34e\"/>\n", kCentreX,
      kCentreY, disc.Radius(limits.top_deg));
  svg += fmt::format("<path d=\"M{} {}H{}M{} {}V{}\" stroke=\"#e4e7ec\" fill=\"none\"/>\n",
                     kCentreX - kRadius, kCentreY, kCentreX + kRadius, kCentreX, kCentreY - kRadius,
                     kCentreY + kRadius);
  for (double tilt = 10; tilt <= disc.full_deg; tilt += 10) {
    // Between two axes, where fewer photographs stand.
    const Eigen::Vector2d at = disc.At({tilt, 292.5});
    svg += Text(at.x() + 2, at.y() - 2, fmt::format("{:.0f}°", tilt), "fill=\"#98a2b3\"");
  }
  const std::string middle = "text-anchor=\"middle\"";
  svg += Text(kCentreX, kCentreY - kRadius - 8, "top of the maps", middle);
  svg += Text(kCentreX, kCentreY + kRadius + 16, "bottom", middle);
  svg += Text(kCentreX + kRadius + 6, kCentreY + 4, "right");
  return svg + Text(kCentreX - kRadius - 6, kCentreY + 4, "left", "text-anchor=\"end\"");
}

std::string Star(const Eigen::Vector2d& at) {
  std::string points;
  for (int i = 0; i < 8; ++i) {
    const double r = i % 2 == 0 ? 5 : 2, a = i * 45 * kDegree;
    points += fmt::format("{:.1f},{:.1f} ", at.x() + r * std::cos(a), at.y() + r * std::sin(a));
  }
  return "<polygon points=\"" + points + "\" fill=\"#f79009\" stroke=\"#b54708\"/>\n";
}

std::string ViewMark(const Disc& disc, const ViewFacts& view, size_t number) {
  const Eigen::Vector2d camera = disc.At(view.camera), light = disc.At(view.light);
  std::string svg = fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#f79009\"/>\n",
      camera.x(), camera.y(), light.x(), light.y());
  svg += Star(light);
  svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"#175cd3\"/>\n", camera.x(),
                     camera.y());
  return svg + Text(camera.x(), camera.y() + 3.5, std::to_string(number),
                    "text-anchor=\"middle\" fill=\"#ffffff\" font-size=\"10\"");
}

std::string Wanted(const Disc& disc, const Direction& direction) {
  const Eigen::Vector2d at = disc.At(direction);
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"10\" fill=\"none\" stroke=\"#d92d20\" "
      "stroke-width=\"2\" stroke-dasharray=\"4 3\"/>\n",
      at.x(), at.y());
}

std::string Legend(bool suggestions) {
  const double y = kHeight - 14;
  std::string svg =
      fmt::format("<circle cx=\"14\" cy=\"{}\" r=\"7\" fill=\"#175cd3\"/>\n", y - 4) +
      Text(26, y, "camera") + Star({92, y - 4}) + Text(102, y, "flash") +
      fmt::format("<circle cx=\"152\" cy=\"{}\" r=\"7\" fill=\"#fef0c7\" stroke=\"#f0c34e\"/>\n",
                  y - 4) +
      Text(164, y, "counts as top view");
  if (!suggestions) return svg;
  return svg +
         fmt::format(
             "<circle cx=\"296\" cy=\"{}\" r=\"7\" fill=\"none\" stroke=\"#d92d20\" "
             "stroke-width=\"2\" stroke-dasharray=\"4 3\"/>\n",
             y - 4) +
         Text(308, y, "take one here");
}

}  // namespace

std::string PolarPictureSvg(const Verdict& verdict) {
  const Disc disc{FullTilt_deg(verdict)};
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"11\" fill=\"#475467\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      kWidth, kHeight);
  svg += Rings(disc, verdict.limits);
  for (const Suggestion& one : verdict.suggestions) svg += Wanted(disc, one.direction);
  for (size_t i = verdict.views.size(); i-- > 0;) svg += ViewMark(disc, verdict.views[i], i + 1);
  return svg + Legend(!verdict.suggestions.empty()) + "</svg>\n";
}

}  // namespace glint
