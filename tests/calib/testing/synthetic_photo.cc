#include "tests/calib/testing/synthetic_photo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/images/image.h"

namespace glint::testing {
namespace {

double Radians(double degrees) { return degrees * std::numbers::pi / 180; }

void BlurRows(std::vector<double>* image, int width, int height, double sigma) {
  const int reach = static_cast<int>(std::ceil(4 * sigma));
  std::vector<double> kernel(2 * reach + 1);
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    sum += kernel[i + reach] = std::exp(-0.5 * i * i / (sigma * sigma));
  }
  std::vector<double> row(width);
  for (int y = 0; y < height; ++y) {
    double* pixels = image->data() + static_cast<size_t>(y) * width;
    for (int x = 0; x < width; ++x) {
      double value = 0;
      for (int i = -reach; i <= reach; ++i) {
        value += kernel[i + reach] * pixels[std::clamp(x + i, 0, width - 1)];
      }
      row[x] = value / sum;
    }
    std::copy(row.begin(), row.end(), pixels);
  }
}

// Normalised camera points of pixel centres. Distortion is smooth: its inverse is taken at every
// fourth pixel and interpolated, which is off by less than 0.001 px.
class RayTable {
 public:
  explicit RayTable(const Camera& camera) : columns_(camera.width_px / kStep + 3) {
    const int rows = camera.height_px / kStep + 3;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const Eigen::Vector2d at(kStep * i, kStep * j);
        uv_.push_back(NormalizedFromImage(camera, at).value_or(Eigen::Vector2d(10, 10)));
      }
    }
  }
  Eigen::Vector2d operator()(double x_px, double y_px) const {
    const int i = static_cast<int>(x_px / kStep), j = static_cast<int>(y_px / kStep);
    const double a = x_px / kStep - i, b = y_px / kStep - j;
    const auto& at = [&](int di, int dj) { return uv_[(j + dj) * columns_ + i + di]; };
    return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
  }

 private:
  static constexpr int kStep = 4;
  int columns_;
  std::vector<Eigen::Vector2d> uv_;
};

std::vector<double> Transposed(const std::vector<double>& image, int width, int height) {
  std::vector<double> out(image.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      out[static_cast<size_t>(x) * height + y] = image[static_cast<size_t>(y) * width + x];
    }
  }
  return out;
}

void Blur(std::vector<double>* image, int width, int height, double sigma) {
  if (sigma <= 0) return;
  BlurRows(image, width, height, sigma);
  *image = Transposed(*image, width, height);
  BlurRows(image, height, width, sigma);
  *image = Transposed(*image, height, width);
}

}  // namespace

std::uint64_t Random::Next() {
  state_ += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

double Random::Uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(Next() >> 11) * 0x1p-53);
}

double Random::Normal() {
  const double u = 1 - Uniform(0, 1), v = Uniform(0, 1);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

GrayImage Photograph(const Board& board, const Camera& camera, const Rigid3& camera_from_sample,
                     const PhotoSettings& settings) {
  const BoardPainter painter(board, settings.margin_mm);
  const Rigid3 sample_from_camera = Inverse(camera_from_sample);
  const int width = camera.width_px, height = camera.height_px;
  const RayTable rays(camera);
  std::vector<double> radiance(static_cast<size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = 0; i < settings.samples * settings.samples; ++i) {
        const double sx = (i % settings.samples + 0.5) / settings.samples;
        const double sy = (i / settings.samples + 0.5) / settings.samples;
        const Eigen::Vector3d ray =
            sample_from_camera.rotation * rays(x + sx, y + sy).homogeneous();
        const Eigen::Vector3d& origin = sample_from_camera.translation;
        if (ray.z() >= 0) continue;
        const Eigen::Vector3d at = origin - ray * (origin.z() / ray.z());
        std::optional<double> covered;
        if (settings.cover) covered = settings.cover(at.x(), at.y());
        if (covered) {
          sum += *covered;
          continue;
        }
        const auto sheet = painter.ReflectanceAt(at.x(), at.y());
        sum += sheet ? settings.ink + *sheet * (settings.paper - settings.ink) : settings.table;
      }
      const double rx = (x + 0.5) / width - 0.5, ry = (y + 0.5) / height - 0.5;
      const double light = settings.peak * (1 - settings.vignette * 2 * (rx * rx + ry * ry));
      radiance[static_cast<size_t>(y) * width + x] =
          light * sum / (settings.samples * settings.samples);
    }
  }
  Blur(&radiance, width, height, settings.blur_px);
  Random random(settings.seed);
  GrayImage image{width, height, std::vector<unsigned char>(radiance.size())};
  for (size_t i = 0; i < radiance.size(); ++i) {
    const double level = 255 * std::pow(std::clamp(radiance[i], 0.0, 1.0), 1 / 2.2);
    image.samples[i] = static_cast<unsigned char>(
        std::clamp(std::lround(level + settings.noise * random.Normal()), 0L, 255L));
  }
  return image;
}

Board SmallBoard() {
  Board board;
  board.squares_x = 8;
  board.squares_y = 6;
  board.square_mm = 20;
  board.marker_mm = 12;
  board.dictionary = "DICT_5X5_100";
  return board;
}

Camera SmallCamera() { return {CameraModel::kRadial, 640, 480, {560, 323.3, 237.1, 0.06, -0.08}}; }

Image RgbOf(const GrayImage& gray) {
  Image image(gray.width, gray.height, {"R", "G", "B"});
  for (size_t i = 0; i < gray.samples.size(); ++i) {
    for (int c = 0; c < 3; ++c) image.channel(c)[i] = gray.samples[i] / 255.0f;
  }
  return image;
}

void WritePhoto(const std::filesystem::path& file, const GrayImage& gray) {
  std::filesystem::create_directories(file.parent_path());
  WritePng(file, RgbOf(gray));
}

Rigid3 LookAt(double distance_mm, double tilt_deg, double azimuth_deg, double roll_deg,
              Eigen::Vector2d target_mm) {
  const double t = Radians(tilt_deg), a = Radians(azimuth_deg);
  const Eigen::Vector3d up(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
  const Eigen::Vector3d target(target_mm.x(), target_mm.y(), 0);
  const Eigen::Vector3d position = target + distance_mm * up;
  const Eigen::Vector3d forward = -up;
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d(0, 1, 0)).normalized();
  right = Eigen::AngleAxisd(Radians(roll_deg), forward) * right;
  const Eigen::Vector3d down = forward.cross(right);
  Rigid3 camera_from_sample;
  camera_from_sample.rotation << right.transpose(), down.transpose(), forward.transpose();
  camera_from_sample.translation = -(camera_from_sample.rotation * position);
  return camera_from_sample;
}

Eigen::Vector2d Project(const Camera& camera, const Rigid3& camera_from_sample,
                        const Eigen::Vector2d& point_mm) {
  return ImageFromCamera(camera,
                         camera_from_sample * Eigen::Vector3d(point_mm.x(), point_mm.y(), 0));
}

}  // namespace glint::testing
