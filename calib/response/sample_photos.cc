#include "calib/response/sample_photos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors/errors.h"
#include "base/files/json.h"
#include "base/files/json_file.h"
#include "base/images/image.h"
#include "base/images/image_format.h"
#include "base/photos/photo.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kCells = 48;           // along the longer side
constexpr double kMargin = 0.2;      // of a cell, left out at each of its sides
constexpr float kClipped = 0.985f;   // a pixel at or above has clipped, whatever the mean says
constexpr double kEven = 4.0 / 255;  // standard deviation inside a spot, stored
constexpr double kColourful = 0.6;   // (most − least) / most of a spot's channels
constexpr double kEqual = 1.05;      // exposures that differ by less are no series

struct Rectangle {
  int x0, y0, x1, y1;  // the end is not in it
};

struct Spread {
  double mean = 0, sigma = 0;
  bool clipped = false;
};

Spread SpreadIn(const StoredImage& image, const Rectangle& r, int channel) {
  double sum = 0, squares = 0;
  int count = 0;
  Spread spread;
  for (int y = r.y0; y < r.y1; ++y) {
    for (int x = r.x0; x < r.x1; ++x) {
      const float value = image.at(static_cast<size_t>(y) * image.width + x, channel);
      spread.clipped = spread.clipped || value >= kClipped;
      sum += value;
      squares += static_cast<double>(value) * value;
      ++count;
    }
  }
  if (count == 0) return {0, 1, true};
  spread.mean = sum / count;
  spread.sigma = std::sqrt(std::max(0.0, squares / count - spread.mean * spread.mean));
  return spread;
}

std::vector<Rectangle> Cells(const StoredImage& image) {
  const double side = static_cast<double>(std::max(image.width, image.height)) / kCells;
  std::vector<Rectangle> cells;
  for (double y = 0; y + side <= image.height; y += side) {
    for (double x = 0; x + side <= image.width; x += side) {
      cells.push_back({static_cast<int>(x + kMargin * side), static_cast<int>(y + kMargin * side),
                       static_cast<int>(x + (1 - kMargin) * side),
                       static_cast<int>(y + (1 - kMargin) * side)});
    }
  }
  return cells;
}

Photo ReadDeveloped(const fs::path& file) {
  Photo photo = ReadPhoto(file);
  if (!photo.is_float() && !IsRawFileName(file)) return photo;
  throw UserError(file, "", "a RAW or float photograph, which is already linear",
                  "give the camera's JPEGs; RAW needs no response curve");
}

void RequireSize(const fs::path& file, const StoredImage& image, const fs::path& first_file,
                 const std::pair<int, int>& size) {
  if (std::pair{image.width, image.height} == size) return;
  throw UserError(file, "size", fmt::format("{}x{} pixels", image.width, image.height),
                  fmt::format("{} has {}x{}; give photographs of one still scene",
                              first_file.string(), size.first, size.second));
}

double ExposureOf(const fs::path& file, const Photo& photo) {
  if (photo.exposure() > 0) return photo.exposure();
  throw UserError(
      file, "EXIF",
      fmt::format(
          "exposure time {} s, ISO {}, f-number {}; 0 means that EXIF does not give the value",
          photo.exposure_time_s, photo.iso, photo.f_number),
      "give --exposures with one number for each photograph");
}

void RequireSeries(const std::vector<double>& exposures, const fs::path& file) {
  const auto [least, most] = std::minmax_element(exposures.begin(), exposures.end());
  if (*most > kEqual * *least) return;
  throw UserError(file, "exposure", "the same exposure in all photographs",
                  "take a series from dark to bright, one stop apart");
}

// A spot with any channel clipped says nothing of the others either, and a colourful one little:
// cameras mix their channels before the tone curve and stretch colours after it.
void AddSpots(const StoredImage& image, const std::vector<Rectangle>& cells, int exposure,
              ResponseProblems* problems) {
  for (size_t i = 0; i < cells.size(); ++i) {
    const std::array<Spread, 3> spreads = {
        SpreadIn(image, cells[i], 0), SpreadIn(image, cells[i], 1), SpreadIn(image, cells[i], 2)};
    if (std::any_of(spreads.begin(), spreads.end(), [](const Spread& s) { return s.clipped; })) {
      continue;
    }
    const auto [least, most] = std::minmax({spreads[0].mean, spreads[1].mean, spreads[2].mean});
    if (most - least > kColourful * most) continue;
    for (int c = 0; c < 3; ++c) {
      if (spreads[c].sigma > kEven) continue;
      (*problems)[c].observations.push_back({static_cast<int>(i), exposure, spreads[c].mean});
    }
  }
}

Rectangle Bounded(const GreyPatch& patch, const StoredImage& image, const fs::path& file) {
  const Rectangle r{static_cast<int>(std::lround(patch.x)), static_cast<int>(std::lround(patch.y)),
                    static_cast<int>(std::lround(patch.x + patch.width)),
                    static_cast<int>(std::lround(patch.y + patch.height))};
  if (r.x0 >= 0 && r.y0 >= 0 && r.x1 <= image.width && r.y1 <= image.height && r.x1 > r.x0 &&
      r.y1 > r.y0) {
    return r;
  }
  throw UserError(
      file, "patches",
      fmt::format("a patch at ({}, {}) of {}x{} pixels, outside a photograph of {}x{}", patch.x,
                  patch.y, patch.width, patch.height, image.width, image.height),
      "give rectangles of the upright photograph, in pixels");
}

}  // namespace

ResponseProblems SampleSeries(const std::vector<fs::path>& photos,
                              const std::vector<double>& exposures) {
  ResponseProblems problems;
  std::vector<Rectangle> cells;
  std::vector<double> used;
  std::pair<int, int> size;
  for (size_t j = 0; j < photos.size(); ++j) {
    const Photo photo = ReadDeveloped(photos[j]);
    if (j == 0) {
      size = {photo.image.width, photo.image.height};
      cells = Cells(photo.image);
    }
    RequireSize(photos[j], photo.image, photos[0], size);
    used.push_back(exposures.empty() ? ExposureOf(photos[j], photo) : exposures[j]);
    AddSpots(photo.image, cells, static_cast<int>(j), &problems);
  }
  RequireSeries(used, photos[0]);
  for (ResponseProblem& problem : problems) {
    problem.exposures = used;
    problem.spots = static_cast<int>(cells.size());
  }
  return problems;
}

std::vector<GreyPatch> ReadPatches(const fs::path& file) {
  const std::string remedy =
      "write {\"patches\": [{\"x\": 100, \"y\": 80, \"width\": 40, \"height\": 40, "
      "\"reflectance\": 0.18}, …]}";
  const Json json = ReadJsonFile(file, remedy, 1u << 20);
  if (!json.is_object() || !json.contains("patches") || !json["patches"].is_array()) {
    throw UserError(file, "patches", "no such list", remedy);
  }
  std::vector<GreyPatch> patches;
  for (const Json& entry : json["patches"]) {
    GreyPatch patch;
    for (auto [key, value] :
         {std::pair{"x", &patch.x}, std::pair{"y", &patch.y}, std::pair{"width", &patch.width},
          std::pair{"height", &patch.height}, std::pair{"reflectance", &patch.reflectance}}) {
      const bool number = entry.is_object() && entry.contains(key) && entry[key].is_number();
      *value = number ? entry[key].get<double>() : -1;
      if (*value >= 0 && *value < 1e6) continue;
      throw UserError(file, fmt::format("patches[{}].{}", patches.size(), key), "no number",
                      remedy);
    }
    if (!(patch.reflectance > 0 && patch.reflectance <= 1)) {
      throw UserError(file, fmt::format("patches[{}].reflectance", patches.size()),
                      fmt::format("{}", patch.reflectance), "give a number from 0 to 1");
    }
    patches.push_back(patch);
  }
  return patches;
}

ResponseProblems SamplePatches(const std::vector<fs::path>& photos,
                               const std::vector<GreyPatch>& patches) {
  ResponseProblems problems;
  for (size_t i = 0; i < photos.size(); ++i) {
    const Photo photo = ReadDeveloped(photos[i]);
    for (size_t p = 0; p < patches.size(); ++p) {
      const Rectangle where = Bounded(patches[p], photo.image, photos[i]);
      for (int c = 0; c < 3; ++c) {
        const Spread spread = SpreadIn(photo.image, where, c);
        if (spread.clipped) continue;
        problems[c].observations.push_back({static_cast<int>(i), static_cast<int>(p), spread.mean});
      }
    }
  }
  for (ResponseProblem& problem : problems) {
    for (const GreyPatch& patch : patches) problem.exposures.push_back(patch.reflectance);
    problem.spots = static_cast<int>(photos.size());
  }
  return problems;
}

}  // namespace glint
