#include "calib/guidance/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr double kTiltStep_deg = 2.5, kLargestTilt_deg = 40, kAzimuthStep_deg = 15;

double MedianDistance_mm(const std::vector<GuidancePhoto>& photos) {
  std::vector<double> distances;
  for (const GuidancePhoto& photo : photos) distances.push_back(photo.camera_in_sample_mm.norm());
  std::sort(distances.begin(), distances.end());
  return distances[distances.size() / 2];
}

Eigen::Vector3d MeanFlashOffset_mm(const std::vector<GuidancePhoto>& photos) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const GuidancePhoto& photo : photos) {
    sum += photo.light_in_sample_mm - photo.camera_in_sample_mm;
  }
  return sum / static_cast<double>(photos.size());
}

std::vector<Suggestion> Candidates(const std::vector<GuidancePhoto>& photos) {
  const double distance_mm = MedianDistance_mm(photos);
  const Eigen::Vector3d offset_mm = MeanFlashOffset_mm(photos);
  std::vector<Suggestion> candidates;
  for (double tilt = 0; tilt <= kLargestTilt_deg; tilt += kTiltStep_deg) {
    for (double azimuth = 0; azimuth < 360; azimuth += kAzimuthStep_deg) {
      const double t = tilt * kDegree, a = azimuth * kDegree;
      Suggestion candidate;
      candidate.direction = {tilt, azimuth};
      candidate.photo.camera_in_sample_mm =
          distance_mm *
          Eigen::Vector3d(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
      candidate.photo.light_in_sample_mm = candidate.photo.camera_in_sample_mm + offset_mm;
      candidates.push_back(candidate);
      if (tilt == 0) break;
    }
  }
  return candidates;
}

std::vector<size_t> Gained(const CoverageGrid& grid, const GuidancePhoto& photo,
                           const std::vector<bool>& dark, double highlight_deg) {
  std::vector<size_t> gained;
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    if (dark[cell] && HalfAngle_deg(photo.camera_in_sample_mm, photo.light_in_sample_mm,
                                    grid.Centre_mm(cell)) <= highlight_deg) {
      gained.push_back(cell);
    }
  }
  return gained;
}

}  // namespace

std::vector<Suggestion> SuggestForHighlights(const Coverage& coverage,
                                             const std::vector<GuidancePhoto>& photos,
                                             double highlight_deg, int most, double least_gain) {
  std::vector<Suggestion> suggestions;
  if (photos.empty()) return suggestions;
  std::vector<bool> dark(coverage.grid.cells());
  for (size_t cell = 0; cell < dark.size(); ++cell) {
    dark[cell] = coverage.least_half_angle_deg[cell] > highlight_deg;
  }
  const std::vector<Suggestion> candidates = Candidates(photos);
  while (static_cast<int>(suggestions.size()) < most) {
    std::vector<size_t> best_gain;
    const Suggestion* best = nullptr;
    for (const Suggestion& candidate : candidates) {
      std::vector<size_t> gain = Gained(coverage.grid, candidate.photo, dark, highlight_deg);
      if (gain.size() <= best_gain.size()) continue;
      best_gain = std::move(gain);
      best = &candidate;
    }
    const double share =
        static_cast<double>(best_gain.size()) / static_cast<double>(coverage.grid.cells());
    if (best == nullptr || share < least_gain) break;
    suggestions.push_back(*best);
    suggestions.back().gain_share = share;
    for (const size_t cell : best_gain) dark[cell] = false;
  }
  return suggestions;
}

AzimuthGap LargestGap(const std::vector<GuidancePhoto>& photos, double least_tilt_deg) {
  std::vector<double> azimuths;
  for (const GuidancePhoto& photo : photos) {
    const Direction direction = DirectionOf(photo.camera_in_sample_mm);
    if (direction.tilt_deg >= least_tilt_deg) azimuths.push_back(direction.azimuth_deg);
  }
  if (azimuths.empty()) return {};
  std::sort(azimuths.begin(), azimuths.end());
  AzimuthGap gap{0, 0};
  for (size_t i = 0; i < azimuths.size(); ++i) {
    const bool last = i + 1 == azimuths.size();
    const double next = last ? azimuths[0] + 360 : azimuths[i + 1];
    if (next - azimuths[i] <= gap.width_deg) continue;
    gap = {next - azimuths[i], std::fmod(0.5 * (azimuths[i] + next), 360)};
  }
  return gap;
}

std::string SideName(double azimuth_deg) {
  constexpr const char* kNames[] = {"right", "top right",   "top",    "top left",
                                    "left",  "bottom left", "bottom", "bottom right"};
  const int sector = static_cast<int>(std::floor(azimuth_deg / 45 + 0.5)) % 8;
  return kNames[sector < 0 ? sector + 8 : sector];
}

std::string InWords(const Direction& direction) {
  if (direction.tilt_deg < 1) return "from directly above";
  return fmt::format("{:.0f}° off vertical toward the {}", direction.tilt_deg,
                     SideName(direction.azimuth_deg));
}

std::string RegionName(const CoverageGrid& grid, const std::vector<bool>& cells) {
  double count = 0, distance = 0;
  Eigen::Vector2d mean(0, 0);
  for (size_t cell = 0; cell < cells.size(); ++cell) {
    if (!cells[cell]) continue;
    const Eigen::Vector2d at = grid.Centre_mm(cell).cwiseQuotient(
        Eigen::Vector2d(0.5 * grid.width_mm, 0.5 * grid.height_mm));
    mean += at;
    distance += at.cwiseAbs().maxCoeff();
    ++count;
  }
  if (count == 0) return "none of it";
  if (count == static_cast<double>(grid.cells())) return "all of it";
  if (count > 0.6 * static_cast<double>(grid.cells())) return "most of it";
  mean /= count;
  constexpr double kAside = 0.3;  // of half the sample
  const bool right = mean.x() > kAside, left = mean.x() < -kAside;
  const bool top = mean.y() > kAside, bottom = mean.y() < -kAside;
  const std::string across = right ? "right" : left ? "left" : "";
  const std::string along = top ? "top" : bottom ? "bottom" : "";
  if (!across.empty() && !along.empty()) return "the " + along + " " + across + " corner";
  if (!across.empty() || !along.empty()) return "the " + across + along + " edge";
  return distance / count > 0.6 ? "the rim" : "the middle";
}

}  // namespace glint
