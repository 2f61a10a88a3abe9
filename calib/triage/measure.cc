#include "calib/triage/measure.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

constexpr int kReduced_px = 1600;
constexpr int kThumbnail_px = 48;
constexpr float kClipped = 0.985f;
constexpr double kRegionMargin = 0.05;  // round the corners' bounding box, of its sides

struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// Of the corners, or the whole picture.
Region BoardRegion(const StoredImage& image, const BoardDetection& detection) {
  if (detection.corners.empty()) return {0, 0, image.width, image.height};
  double left = image.width, right = 0, top = image.height, bottom = 0;
  for (const CornerObservation& corner : detection.corners) {
    left = std::min(left, corner.point_px.x());
    right = std::max(right, corner.point_px.x());
    top = std::min(top, corner.point_px.y());
    bottom = std::max(bottom, corner.point_px.y());
  }
  const double dx = kRegionMargin * (right - left) + 1, dy = kRegionMargin * (bottom - top) + 1;
  return {std::max(0, static_cast<int>(left - dx)), std::max(0, static_cast<int>(top - dy)),
          std::min(image.width, static_cast<int>(right + dx)),
          std::min(image.height, static_cast<int>(bottom + dy))};
}

void MeasureExposure(const Photo& photo, const GrayImage& gray, const Region& region,
                     PhotoMeasures* measures) {
  std::array<size_t, 256> histogram{};
  size_t count = 0, clipped = 0;
  photo.image.Visit([&](const auto& samples) {
    for (int y = region.y0; y < region.y1; y += 2) {
      for (int x = region.x0; x < region.x1; x += 2) {
        const size_t i = static_cast<size_t>(y) * gray.width + x;
        ++histogram[gray.samples[i]];
        ++count;
        const auto brightest = std::max({samples[3 * i], samples[3 * i + 1], samples[3 * i + 2]});
        if (!photo.is_float() && StoredImage::ValueOf(brightest) >= kClipped) ++clipped;
      }
    }
  });
  if (count == 0) return;
  measures->clipped = static_cast<double>(clipped) / static_cast<double>(count);
  size_t above = 0;
  int code = 255;
  while (code > 0 && above + histogram[code] <= count / 100) above += histogram[code--];
  measures->white = code / 255.0;
}

// A line of pixels through the region, along a row or a column.
struct Line {
  const GrayImage& image;
  bool along_row;
  int at, from, to;
  int Value(int i) const { return along_row ? image.at(i, at) : image.at(at, i); }
  int Beside(int i, int step) const {
    return along_row ? image.at(i, at + step) : image.at(at + step, i);
  }
};

// Edge between the turning points `from` and `to` of a line: height over steepest slope. For a step
// blurred by a Gaussian of σ that is √(2π)·σ. Edges that run along the line are not measured.
void MeasureEdge(const Line& line, int from, int to, std::vector<double>* sigmas) {
  constexpr int kHeight = 50;  // levels
  const int height = std::abs(line.Value(to) - line.Value(from));
  if (height < kHeight) return;
  int steepest = from + 1, slope2 = 0;  // twice the slope
  for (int i = std::max(from, line.from + 1); i <= std::min(to, line.to - 2); ++i) {
    const int s = std::abs(line.Value(i + 1) - line.Value(i - 1));
    if (s > slope2) {
      slope2 = s;
      steepest = i;
    }
  }
  const int across = std::abs(line.Beside(steepest, 1) - line.Beside(steepest, -1));
  if (slope2 == 0 || across > slope2) return;
  sigmas->push_back(2.0 * height / slope2 / 2.5066);
}

void MeasureLine(const Line& line, std::vector<double>* sigmas) {
  constexpr int kNoise = 12;  // levels; smaller turns are none
  int start = line.from, extreme = line.from;
  bool rising = true;
  for (int i = line.from + 1; i < line.to; ++i) {
    const int from_extreme = line.Value(i) - line.Value(extreme);
    if (rising ? from_extreme >= 0 : from_extreme <= 0) {
      extreme = i;
    } else if (std::abs(from_extreme) > kNoise) {
      MeasureEdge(line, start, extreme, sigmas);
      start = extreme;
      extreme = i;
      rising = !rising;
    }
  }
}

double EdgeWidth_px(const GrayImage& image, const Region& region, bool along_rows) {
  constexpr int kEvery = 4;
  constexpr size_t kLeastEdges = 40;
  std::vector<double> sigmas;
  const int first = (along_rows ? region.y0 : region.x0) + 1;
  const int last = (along_rows ? region.y1 : region.x1) - 1;
  for (int at = first; at < last; at += kEvery) {
    MeasureLine({image, along_rows, at, along_rows ? region.x0 : region.y0,
                 along_rows ? region.x1 : region.y1},
                &sigmas);
  }
  if (sigmas.size() < kLeastEdges) return 0;
  const auto tenth = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 10);
  std::nth_element(sigmas.begin(), tenth, sigmas.end());
  return *tenth;
}

std::vector<unsigned char> Thumbnail(const GrayImage& image) {
  std::vector<unsigned char> thumbnail;
  for (int row = 0; row < kThumbnail_px; ++row) {
    for (int column = 0; column < kThumbnail_px; ++column) {
      const int x0 = column * image.width / kThumbnail_px, y0 = row * image.height / kThumbnail_px;
      const int x1 = std::max(x0 + 1, (column + 1) * image.width / kThumbnail_px);
      const int y1 = std::max(y0 + 1, (row + 1) * image.height / kThumbnail_px);
      int sum = 0, count = 0;
      for (int y = y0; y < std::min(y1, image.height); ++y) {
        for (int x = x0; x < std::min(x1, image.width); ++x, ++count) sum += image.at(x, y);
      }
      thumbnail.push_back(static_cast<unsigned char>(count > 0 ? sum / count : 0));
    }
  }
  return thumbnail;
}

Photo WithoutSamples(const Photo& photo) {
  Photo facts;
  facts.image.width = photo.image.width;
  facts.image.height = photo.image.height;
  facts.bits = photo.bits;
  facts.format = photo.format;
  facts.colour = photo.colour;
  facts.focal_length_35mm = photo.focal_length_35mm;
  facts.exposure_time_s = photo.exposure_time_s;
  facts.iso = photo.iso;
  facts.f_number = photo.f_number;
  facts.camera_model = photo.camera_model;
  facts.orientation = photo.orientation;
  facts.exif = photo.exif;
  return facts;
}

double Brightest(const StoredImage& image) {
  return image.Visit([]<class T>(const std::vector<T>& samples) {
    T brightest = 0;
    for (const T sample : samples) brightest = std::max(brightest, sample);
    return static_cast<double>(StoredImage::ValueOf(brightest));
  });
}

double MedianBlur(const BoardDetection& detection) {
  std::vector<double> blurs;
  for (const CornerObservation& corner : detection.corners) blurs.push_back(corner.blur_px);
  if (blurs.empty()) return 0;
  const auto middle = blurs.begin() + static_cast<std::ptrdiff_t>(blurs.size() / 2);
  std::nth_element(blurs.begin(), middle, blurs.end());
  return *middle;
}

}  // namespace

PhotoMeasures MeasurePhoto(const std::string& name, const Photo& photo, const GrayImage& gray,
                           const BoardDetection& detection) {
  PhotoMeasures measures;
  measures.name = name;
  measures.file = WithoutSamples(photo);
  measures.corners = static_cast<int>(detection.corners.size());
  measures.blur_px = MedianBlur(detection);
  measures.brightest = Brightest(photo.image);
  int factor = 1;
  const GrayImage small = Reduced(gray, kReduced_px, &factor);
  const Region region = BoardRegion(photo.image, detection);
  measures.edge_px = std::max(EdgeWidth_px(gray, region, true), EdgeWidth_px(gray, region, false));
  MeasureExposure(photo, gray, region, &measures);
  measures.thumbnail = Thumbnail(small);
  return measures;
}

}  // namespace glint
