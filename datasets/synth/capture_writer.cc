#include "datasets/synth/capture_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/board_file.h"
#include "base/formats/calibration.h"
#include "base/formats/manifest.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "base/parallel/parallel.h"
#include "base/programs/progress.h"
#include "datasets/procedural/random.h"
#include "datasets/synth/photo_file.h"
#include "datasets/synth/photo_renderer.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kBandRows = 32;  // rows a thread renders at a time

// Numbers as short as they can be while reading back the same.
std::string List(const std::array<double, 3>& v) {
  return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

Json JsonOf(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

std::string PhotoName(int index, const std::string& format) {
  return fmt::format("photos/photo_{:03}.{}", index, format);
}

std::string InlineBoard(const Board& board) {
  return fmt::format(
      "[board]\nkind = \"charuco\"\nsquares = [{}, {}]\nsquare_mm = {}\nmarker_mm = {}\n"
      "dictionary = \"{}\"\nwindow = [{}, {}, {}, {}]\n\n",
      board.squares_x, board.squares_y, board.square_mm, board.marker_mm, board.dictionary,
      board.window->first_column, board.window->first_row, board.window->columns,
      board.window->rows);
}

// The sample's corners in the first photograph, as a person reads them off a picture: to a tenth of
// a pixel.
std::string PosesToml(const CapturePlan& plan, const std::string& format) {
  const double half_mm = 0.5 * plan.options.sample_mm;
  std::string corners;
  for (const auto& [x, y] : {std::pair{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}) {
    const Eigen::Vector2d point_px =
        ImageFromCamera(plan.camera, plan.photos[0].camera_from_sample *
                                         Eigen::Vector3d(x * half_mm, y * half_mm, 0));
    corners +=
        fmt::format("{}[{:.1f}, {:.1f}]", corners.empty() ? "" : ", ", point_px.x(), point_px.y());
  }
  return fmt::format(
      "[poses]\nphoto = \"{}\"\ncorners_px = [{}]\n\n[calib]\nposes = \"colmap\"\n\n",
      PhotoName(0, format), corners);
}

fs::path PhotoFile(const fs::path& folder, int index, const std::string& format) {
  return folder / PhotoName(index, format);
}

std::string CaptureToml(const CapturePlan& plan, const SyntheticCaptureOptions& options) {
  const double side = plan.options.sample_mm;
  std::string text;
  text += "# A synthetic capture; its ground truth is in truth/.\n";
  text += fmt::format("[sample]\nsize_mm = [{}, {}]\nresolution_px = {}\n\n", side, side,
                      options.resolution_px);
  text += fmt::format("[photos]\nfiles = [\"photos/*.{}\"]\n\n", options.format);
  if (!plan.options.has_board) {
    text += PosesToml(plan, options.format);
  } else {
    text += plan.options.board ? "[board]\nfile = \"board.json\"\n\n" : InlineBoard(plan.board);
  }
  text += fmt::format("[radiometry]\nencoding = \"{}\"\n\n",
                      options.format == "exr" ? "linear" : options.encoding);
  text += "[export]\nname = \"synthetic\"\n\n";
  if (!options.tell_flash) return text;
  text += "[light]\noffset_mm = " + List(plan.options.flash_offset_mm) + "\n";
  return text;
}

Calibration TrueCalibration(const CapturePlan& plan, const std::string& format) {
  Calibration calibration;
  calibration.cameras = {plan.camera};
  calibration.light_rgb = plan.light_rgb;
  calibration.light_power_known = true;
  calibration.ambient_rgb = plan.ambient_rgb;
  for (size_t i = 0; i < plan.photos.size(); ++i) {
    CalibratedPhoto photo;
    photo.photo = PhotoName(static_cast<int>(i), format);
    photo.camera_from_sample = plan.photos[i].camera_from_sample;
    photo.light_in_camera_mm = photo.camera_from_sample * plan.photos[i].light_in_sample_mm;
    photo.exposure = plan.photos[i].exposure;
    calibration.photos.push_back(photo);
  }
  return calibration;
}

Json TruthFacts(const CapturePlan& plan, const MaterialSource& material,
                const SyntheticCaptureOptions& options) {
  return {{"material", material.name},
          {"seed", plan.options.seed},
          {"sample_size_mm", {plan.options.sample_mm, plan.options.sample_mm}},
          {"light_rgb", JsonOf(plan.light_rgb)},
          {"ambient_rgb", JsonOf(plan.ambient_rgb)},
          {"paper_albedo", kPaperAlbedo},
          {"ink_albedo", kInkAlbedo},
          {"table_albedo", kTableAlbedo},
          {"encoding", options.format == "exr" ? "linear" : options.encoding},
          {"lens_blur_px", options.lens_blur_px},
          {"noise",
           {{"full_well_electrons", options.noise.full_well_electrons},
            {"read_electrons", options.noise.read_electrons},
            {"scale", options.noise.scale}}}};
}

void WriteTruth(const fs::path& folder, const CapturePlan& plan, const MaterialSource& material,
                const SyntheticCaptureOptions& options) {
  fs::create_directories(folder / "calib");
  WriteSvbrdf(folder / "svbrdf.exr", material.maps, ReflectanceConvention::Photograph());
  Manifest manifest;
  manifest.stage = "calib";
  manifest.options["source"] = "glint-synth capture";
  manifest.data = ToJson(TrueCalibration(plan, options.format));
  WriteFileAtomically(folder / "calib" / "manifest.json", ToJson(manifest).dump(2) + "\n");
  WriteFileAtomically(folder / "truth.json", TruthFacts(plan, material, options).dump(2) + "\n");
}

PhotoFacts FactsOf(const CapturePlan& plan, int index, int jpeg_quality) {
  constexpr double kFullFrameDiagonal_mm = 43.267, kSensorDiagonal_mm = 12.2;
  const double diagonal_px = std::hypot(plan.camera.width_px, plan.camera.height_px);
  const double diagonals = plan.camera.focal_length_x() / diagonal_px;
  PhotoFacts facts;
  facts.focal_length_35mm = diagonals * kFullFrameDiagonal_mm;
  facts.focal_length_mm = diagonals * kSensorDiagonal_mm;
  facts.exposure_time_s = plan.photos[index].exif_exposure / 60;
  facts.iso = 50;
  facts.f_number = 1.8;
  facts.jpeg_quality = jpeg_quality;
  return facts;
}

// One photograph: rendered, noised, counted and written.
class PhotoShoot {
 public:
  PhotoShoot(const CapturePlan& plan, const PhotoRenderer& renderer,
             const SyntheticCaptureOptions& options, int threads)
      : plan_(plan),
        renderer_(renderer),
        options_(options),
        encoder_(ParseEncoding(options.encoding)),
        threads_(threads) {}

  // Returns the share of clipped pixels.
  double Take(int index, const fs::path& file) {
    const int width = plan_.camera.width_px, height = plan_.camera.height_px;
    const bool linear = options_.format == "exr";
    if (linear && image_.samples.empty()) image_ = Image(width, height, {"R", "G", "B"});
    if (!linear) bytes_.resize(static_cast<size_t>(3) * width * height);
    std::atomic<std::int64_t> clipped{0};
    const int bands = (height + kBandRows - 1) / kBandRows;
    ForEachPiece(bands, threads_, [&](int band) {
      const int first = band * kBandRows;
      clipped += TakeBand(index, first, std::min(kBandRows, height - first));
    });
    if (linear) {
      WriteExr(file, image_);
    } else {
      WritePhoto(file, width, height, bytes_, FactsOf(plan_, index, options_.jpeg_quality));
    }
    return static_cast<double>(clipped) / (static_cast<double>(width) * height);
  }

 private:
  // Radiance of a band behind the lens.
  std::vector<float> SeeBand(int index, int first_row, int rows) const {
    const int width = plan_.camera.width_px;
    const size_t stride = 3 * static_cast<size_t>(width);
    // One row more on each side for the blur; at the picture's border the last one twice.
    const int begin = std::max(first_row - 1, 0);
    const int end = std::min(first_row + rows + 1, plan_.camera.height_px);
    std::vector<float> seen((end - begin) * stride);
    renderer_.RenderRows(index, begin, end - begin, seen);
    const auto row = [&](size_t i) { return seen.begin() + static_cast<ptrdiff_t>(i * stride); };
    if (begin == first_row) {
      const std::vector<float> first(row(0), row(1));
      seen.insert(seen.begin(), first.begin(), first.end());
    }
    if (end == first_row + rows) {
      const std::vector<float> last(seen.end() - static_cast<ptrdiff_t>(stride), seen.end());
      seen.insert(seen.end(), last.begin(), last.end());
    }
    std::vector<float> blurred;
    BlurRows(seen, width, rows + 2, options_.lens_blur_px, &blurred);
    return blurred;
  }

  std::int64_t TakeBand(int index, int first_row, int rows) {
    const size_t begin = static_cast<size_t>(first_row) * plan_.camera.width_px;
    const size_t pixels = static_cast<size_t>(rows) * plan_.camera.width_px;
    std::vector<float> radiance = SeeBand(index, first_row, rows);
    const std::uint64_t seed =
        procedural::Mix64(plan_.options.seed ^ (0x401500000000ull + static_cast<unsigned>(index)));
    std::int64_t clipped = 0;
    for (size_t i = 0; i < pixels; ++i) {
      float* rgb = radiance.data() + 3 * i;
      for (size_t c = 0; c < 3; ++c) {
        rgb[c] = NoisyRadiance(rgb[c], options_.noise, seed, 3 * (begin + i) + c);
        Store(begin + i, c, rgb[c]);
      }
      if (std::max({rgb[0], rgb[1], rgb[2]}) >= 1.0f) ++clipped;
    }
    return clipped;
  }

  void Store(size_t pixel, size_t channel, float value) {
    if (image_.samples.empty()) {
      bytes_[3 * pixel + channel] = encoder_(value);
    } else {
      image_.samples[channel * image_.pixels() + pixel] = std::max(value, 0.0f);
    }
  }

  const CapturePlan& plan_;
  const PhotoRenderer& renderer_;
  const SyntheticCaptureOptions& options_;
  EightBitEncoder encoder_;
  int threads_;
  Image image_;
  std::vector<unsigned char> bytes_;
};

void PrepareFolder(const fs::path& folder, bool overwrite) {
  if (fs::exists(folder / "capture.toml") && !overwrite) {
    throw UserError(folder, "", "an existing capture",
                    "choose another folder, or give --force to replace it");
  }
  fs::create_directories(folder / "photos");
  // Photographs of an earlier, longer capture would be taken for this one's.
  for (const auto& entry : fs::directory_iterator(folder / "photos")) {
    if (entry.path().filename().string().starts_with("photo_")) fs::remove(entry.path());
  }
  fs::create_directories(folder / "truth");
}

}  // namespace

std::string SyntheticCaptureSummary::BriefReport() const {
  double largest = 0;
  for (const double share : clipped_share) largest = std::max(largest, share);
  return fmt::format("{} photographs of {} x {} pixels; at most {:.2f} % of a photograph clips",
                     photos, width_px, height_px, 100 * largest);
}

SyntheticCaptureSummary WriteSyntheticCapture(const fs::path& folder,
                                              const MaterialSource& material,
                                              const SyntheticCaptureOptions& options, int threads) {
  const CapturePlan plan = PlanCapture(options.plan);
  if (!(options.lens_blur_px >= 0 && options.lens_blur_px <= kMostBlur_px)) {
    throw UserError(fmt::format("lens-blur-px: use 0 to {}", kMostBlur_px));
  }
  PrepareFolder(folder, options.overwrite);
  const PhotoRenderer renderer(plan, material.maps, threads);
  PhotoShoot shoot(plan, renderer, options, threads);
  SyntheticCaptureSummary summary;
  summary.photos = options.plan.photos;
  summary.width_px = plan.camera.width_px;
  summary.height_px = plan.camera.height_px;
  Progress progress("photographs", summary.photos);
  for (int i = 0; i < summary.photos; ++i) {
    summary.clipped_share.push_back(shoot.Take(i, PhotoFile(folder, i, options.format)));
    progress.Advance();
  }
  WriteTruth(folder / "truth", plan, material, options);
  if (options.plan.has_board && options.plan.board) {
    WriteFileAtomically(folder / "board.json", ToJson(BoardFile{plan.board, {}}).dump(1) + "\n");
  }
  WriteFileAtomically(folder / "capture.toml", CaptureToml(plan, options));
  return summary;
}

}  // namespace glint
