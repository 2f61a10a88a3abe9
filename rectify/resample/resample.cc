#include "rectify/resample/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel/parallel.h"
#include "rectify/resample/footprint.h"

namespace glint {
namespace {

constexpr int kTile = 64;
constexpr double kNoCeiling = std::numeric_limits<double>::infinity();

struct Gathered {
  double rgb[3] = {0, 0, 0};
  double weight = 0;
  bool saturated = false;
};

// Sum of the pixels within the kernel's ellipse round `centre`, weighted.
template <class Reader>
Gathered Gather(const Reader& reader, int width, int height, const FilterKernel& kernel,
                const Footprint& footprint, const Eigen::Vector2d& centre) {
  Gathered sum;
  const double r2 = kernel.radius() * kernel.radius();
  const double half_y = kernel.radius() * std::sqrt(footprint.variance_yy);
  const int y0 = std::max(0, static_cast<int>(std::ceil(centre.y() - half_y - 0.5)));
  const int y1 = std::min(height - 1, static_cast<int>(std::floor(centre.y() + half_y - 0.5)));
  for (int y = y0; y <= y1; ++y) {
    // Roots of xx·dx² + xy·dy·dx + (yy·dy² − r²) = 0 bound the row's run.
    const double dy = y + 0.5 - centre.y();
    const double half_b = footprint.xy * dy / 2;
    const double rest = footprint.yy * dy * dy;
    const double discriminant = half_b * half_b - footprint.xx * (rest - r2);
    if (discriminant <= 0) continue;
    const double root = std::sqrt(discriminant);
    const double left = centre.x() + (-half_b - root) / footprint.xx;
    const double right = centre.x() + (-half_b + root) / footprint.xx;
    const int x0 = std::max(0, static_cast<int>(std::ceil(left - 0.5)));
    const int x1 = std::min(width - 1, static_cast<int>(std::floor(right - 0.5)));
    const float a = static_cast<float>(footprint.xx);
    const float b = static_cast<float>(2 * half_b);
    const float c = static_cast<float>(rest);
    float row_r = 0, row_g = 0, row_b = 0, row_weight = 0;
    const size_t row = static_cast<size_t>(y) * width;
    for (int x = x0; x <= x1; ++x) {
      const float dx = static_cast<float>(x + 0.5 - centre.x());
      const float w = kernel.Weight(std::max((a * dx + b) * dx + c, 0.0f));
      const LinearPhoto::Pixel pixel = reader.At(row + x);
      row_r += w * pixel.rgb[0];
      row_g += w * pixel.rgb[1];
      row_b += w * pixel.rgb[2];
      row_weight += w;
      sum.saturated |= pixel.saturated;
    }
    sum.rgb[0] += row_r;
    sum.rgb[1] += row_g;
    sum.rgb[2] += row_b;
    sum.weight += row_weight;
  }
  return sum;
}

// A texel that is a pixel of its own. The radial kernel would not leave it as it is: at whole
// distances its weights are not 0.
template <class Reader>
Gathered Take(const Reader& reader, int width, const Eigen::Vector2d& centre) {
  const auto column = static_cast<size_t>(centre.x()), row = static_cast<size_t>(centre.y());
  const LinearPhoto::Pixel pixel = reader.At(row * static_cast<size_t>(width) + column);
  return {{pixel.rgb[0], pixel.rgb[1], pixel.rgb[2]}, 1, pixel.saturated};
}

// Image points of the texel centres of a tile and of one texel around it, for differences.
class TileGrid {
 public:
  TileGrid(const PlaneProjection& projection, const SamplePlane& plane, int column, int row,
           int columns, int rows)
      : columns_(columns + 2), points_(static_cast<size_t>(columns + 2) * (rows + 2)) {
    for (int j = -1; j <= rows; ++j) {
      for (int i = -1; i <= columns; ++i) {
        points_[Index(i, j)] = Project(projection, plane, column + i, row + j);
      }
    }
  }

  const Eigen::Vector2d& At(int i, int j) const { return points_[Index(i, j)]; }

  TexelJacobian Jacobian(int i, int j) const {
    const Eigen::Vector2d by_column = (At(i + 1, j) - At(i - 1, j)) / 2;
    const Eigen::Vector2d by_row = (At(i, j + 1) - At(i, j - 1)) / 2;
    return {by_column.x(), by_row.x(), by_column.y(), by_row.y()};
  }

 private:
  static Eigen::Vector2d Project(const PlaneProjection& projection, const SamplePlane& plane,
                                 int column, int row) {
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    return projection.ImageFromPlane(plane.x_mm(column), plane.y_mm(row))
        .value_or(Eigen::Vector2d(kNowhere, kNowhere));
  }
  size_t Index(int i, int j) const { return static_cast<size_t>(j + 1) * columns_ + (i + 1); }

  size_t columns_;
  std::vector<Eigen::Vector2d> points_;
};

// Whether the parallelogram of the texel lies in the picture. False for NaN.
bool AreaInside(const Eigen::Vector2d& centre, const TexelJacobian& j, int width, int height,
                double border_px) {
  const double half_x = (std::abs(j.x_by_column) + std::abs(j.x_by_row)) / 2 - border_px;
  const double half_y = (std::abs(j.y_by_column) + std::abs(j.y_by_row)) / 2 - border_px;
  return centre.x() - half_x >= 0 && centre.x() + half_x <= width && centre.y() - half_y >= 0 &&
         centre.y() + half_y <= height;
}

class Resampler {
 public:
  Resampler(const LinearPhoto& photo, const PlaneProjection& projection, const SamplePlane& plane,
            const ResampleOptions& options, ResampledView* view)
      : photo_(photo),
        projection_(projection),
        plane_(plane),
        options_(options),
        kernel_(options.filter),
        clamps_(!photo.is_float() && (options.vignetting || options.colour ||
                                      options.gain_rgb != ResampleOptions().gain_rgb)),
        view_(view) {}

  void Tile(int column, int row) const {
    const int columns = std::min(kTile, plane_.width - column);
    const int rows = std::min(kTile, plane_.height - row);
    const TileGrid grid(projection_, plane_, column, row, columns, rows);
    photo_.Visit([&](const auto& reader) {
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          const size_t texel = static_cast<size_t>(row + j) * plane_.width + column + i;
          if (view_->status[texel] == TexelStatus::kMasked) continue;
          view_->status[texel] = Texel(reader, grid.At(i, j), grid.Jacobian(i, j), texel);
        }
      }
    });
  }

 private:
  template <class Reader>
  TexelStatus Texel(const Reader& reader, const Eigen::Vector2d& centre,
                    const TexelJacobian& jacobian, size_t texel) const {
    if (!AreaInside(centre, jacobian, photo_.width(), photo_.height(), options_.border_px) ||
        jacobian.Mirrored()) {
      return TexelStatus::kOutside;
    }
    const Gathered sum = options_.pixels_as_they_are
                             ? Take(reader, photo_.width(), centre)
                             : Gather(reader, photo_.width(), photo_.height(), kernel_,
                                      FootprintFromJacobian(jacobian), centre);
    // Only a picture smaller than the kernel's lobes can leave no weight.
    if (!(sum.weight > 1e-3)) return TexelStatus::kOutside;
    const size_t texels = view_->status.size();
    const Eigen::Vector3d mean = Eigen::Vector3d(sum.rgb) / sum.weight;
    const Eigen::Vector3d rgb = sum.saturated ? mean : AtTheLens(mean, centre);
    const double ceiling = sum.saturated || !clamps_ ? kNoCeiling : 1;
    for (int c = 0; c < 3; ++c) {
      view_->rgb[c * texels + texel] = static_cast<float>(std::min(std::max(rgb[c], 0.0), ceiling));
    }
    return sum.saturated ? TexelStatus::kSaturated : TexelStatus::kUsable;
  }

  // Without the lens's fall-off, in one white balance and in the right colours.
  Eigen::Vector3d AtTheLens(const Eigen::Vector3d& rgb, const Eigen::Vector2d& image_point) const {
    const double gain =
        options_.vignetting ? 1 / Vignetting(*options_.vignetting, image_point) : 1.0;
    Eigen::Vector3d gained;
    for (int c = 0; c < 3; ++c) gained[c] = gain * options_.gain_rgb[c] * rgb[c];
    return options_.colour ? (*options_.colour)(gained) : gained;
  }

  const LinearPhoto& photo_;
  const PlaneProjection& projection_;
  const SamplePlane& plane_;
  const ResampleOptions& options_;
  const FilterKernel kernel_;
  const bool clamps_;  // what is corrected may pass 1, where the photo clips
  ResampledView* view_;
};

}  // namespace

bool TexelsArePixels(const PlaneProjection& projection, const SamplePlane& plane) {
  // Sizes in millimetres are rounded; a twentieth of a pixel is less than filters blur by.
  constexpr double kNear_px = 0.05;
  const auto first = projection.ImageFromPlane(plane.x_mm(0), plane.y_mm(0));
  if (!first) return false;
  for (const int column : {-1, plane.width}) {
    for (const int row : {-1, plane.height}) {
      const auto at = projection.ImageFromPlane(plane.x_mm(column), plane.y_mm(row));
      if (!at) return false;
      const Eigen::Vector2d pixel = *at - Eigen::Vector2d(0.5, 0.5);
      const Eigen::Vector2d expected = *first + Eigen::Vector2d(column, row);
      if ((*at - expected).norm() > kNear_px) return false;
      if ((pixel - pixel.array().round().matrix()).norm() > kNear_px) return false;
    }
  }
  return true;
}

ResampledView ResampleToPlane(const LinearPhoto& photo, const PlaneProjection& projection,
                              const SamplePlane& plane, const ResampleOptions& options,
                              const std::vector<TexelStatus>& status_before) {
  const size_t texels = static_cast<size_t>(plane.width) * plane.height;
  ResampledView view{plane.width, plane.height, std::vector<float>(3 * texels, 0.0f),
                     status_before};
  if (view.status.size() != texels) view.status.assign(texels, TexelStatus::kOutside);
  const Resampler resampler(photo, projection, plane, options, &view);

  const int tiles_x = (plane.width + kTile - 1) / kTile;
  const int tiles = tiles_x * ((plane.height + kTile - 1) / kTile);
  ForEachPiece(tiles, options.threads,
               [&](int tile) { resampler.Tile(tile % tiles_x * kTile, tile / tiles_x * kTile); });
  return view;
}

}  // namespace glint
