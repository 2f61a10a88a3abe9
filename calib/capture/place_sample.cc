#include "calib/capture/place_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/model/registration.h"
#include "base/parallel/parallel.h"
#include "base/text/name_list.h"
#include "calib/capture/camera_groups.h"
#include "calib/capture/pose_source.h"

namespace glint {
namespace {

double Longest_mm(const Capture& capture) {
  return std::max(capture.sample_size_mm[0], capture.sample_size_mm[1]);
}

const SamplePicture& PictureOf(const std::vector<DetectedPhoto>& detected,
                               const CalibratedPhoto& photo) {
  return std::find_if(detected.begin(), detected.end(),
                      [&](const DetectedPhoto& p) { return p.name == photo.photo; })
      ->picture;
}

// Where the top view's pixels lie in the picture. Of every kStep-th pixel, and between them by
// interpolation: lenses bend little.
class LookUpMap {
 public:
  LookUpMap(const Camera& camera, const Rigid3& camera_from_board, const SamplePicture& picture)
      : camera_(camera), camera_from_board_(camera_from_board), picture_(picture) {}

  void Fill(const cv::Size& size, double pixel_mm, cv::Mat* columns, cv::Mat* rows) const {
    const cv::Size coarse(size.width / kStep + 2, size.height / kStep + 2);
    cv::Mat x(coarse, CV_32F), y(coarse, CV_32F);
    for (int row = 0; row < coarse.height; ++row) {
      for (int column = 0; column < coarse.width; ++column) {
        const Eigen::Vector2d at = InPicture(((column * kStep + 0.5) - 0.5 * size.width) * pixel_mm,
                                             (0.5 * size.height - (row * kStep + 0.5)) * pixel_mm);
        x.at<float>(row, column) = static_cast<float>(at.x());
        y.at<float>(row, column) = static_cast<float>(at.y());
      }
    }
    const cv::Matx23d enlarge(1.0 / kStep, 0, 0, 0, 1.0 / kStep, 0);
    const int how = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
    cv::warpAffine(x, *columns, enlarge, size, how, cv::BORDER_REPLICATE);
    cv::warpAffine(y, *rows, enlarge, size, how, cv::BORDER_REPLICATE);
  }

 private:
  static constexpr int kStep = 8;

  // Pixel centres at whole numbers; far outside where there is no image.
  Eigen::Vector2d InPicture(double x_mm, double y_mm) const {
    const Eigen::Vector3d point = camera_from_board_ * Eigen::Vector3d(x_mm, y_mm, 0);
    if (!(point.z() > 0)) return {-1e6, -1e6};
    const Eigen::Vector2d at = ImageFromCamera(camera_, point);
    return {(at.x() - picture_.left_px) * picture_.scale - 0.5,
            (at.y() - picture_.top_px) * picture_.scale - 0.5};
  }

  const Camera& camera_;
  const Rigid3& camera_from_board_;
  const SamplePicture& picture_;
};

TopView TopViewOf(const Camera& camera, const CalibratedPhoto& photo, const SamplePicture& picture,
                  const cv::Size& size, double pixel_mm) {
  TopView view{size.width, size.height, {}, Inverse(photo.camera_from_sample).translation};
  view.radiance.resize(static_cast<size_t>(size.area()));
  if (picture.values.empty()) return view;  // it does not show the sample
  cv::Mat columns, rows, found;
  LookUpMap(camera, photo.camera_from_sample, picture).Fill(size, pixel_mm, &columns, &rows);
  const cv::Mat values(picture.height, picture.width, CV_16U,
                       const_cast<std::uint16_t*>(picture.values.data()));
  cv::remap(values, found, columns, rows, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  for (size_t i = 0; i < view.radiance.size(); ++i) {
    const float root = static_cast<float>(found.ptr<std::uint16_t>()[i]) / 65535;
    view.radiance[i] = root * root;
  }
  return view;
}

void FillPriors(const Capture& capture, const CalibOptions& options, RegistrationProblem* problem) {
  problem->homography_sd_mm = constants::kCalibratedPlaceSd * Longest_mm(capture);
  const bool board = PoseSourceOf(capture, options) == PoseSource::kBoard;
  problem->height_sd_mm =
      board ? constants::kSampleHeightSd_mm : constants::kFittedPlaneSd * Longest_mm(capture);
  if (!capture.sample_height_mm) return;
  problem->height_mm = *capture.sample_height_mm;
  problem->height_sd_mm =
      problem->height_mm == 0
          ? 0
          : std::max(constants::kMeasuredHeightSd_mm,
                     constants::kMeasuredHeightShare * std::abs(problem->height_mm));
}

double Degrees(double radians) { return radians * 180 / std::numbers::pi; }

Json MovesMetrics(const CalibSummary& summary) {
  Json moved = Json::array();
  const std::vector<SampleMove>& moves = summary.placement.moves;
  for (size_t i = 0; i < moves.size(); ++i) {
    if (moves[i].none()) continue;
    moved.push_back({{"photo", summary.calibration.photos[i].photo},
                     {"right_mm", moves[i].shift_mm.x()},
                     {"up_mm", moves[i].shift_mm.y()},
                     {"turn_deg", Degrees(moves[i].turn_rad)}});
  }
  return moved;
}

// Names of the photographs of that texture.
std::vector<std::string> Showing(int texture, const CalibSummary& summary) {
  const std::vector<size_t> flash = summary.FlashPhotos();
  std::vector<std::string> names;
  for (size_t k = 0; k < summary.placement.textures.size(); ++k) {
    if (summary.placement.textures[k] == texture) names.push_back(summary.photos[flash[k]].name);
  }
  return names;
}

double Tilt_deg(const PlaneValues& plane) {
  return Degrees(std::atan(std::hypot(plane[1], plane[2])));
}

}  // namespace

SampleRegistration FindSamplePlane(const Capture& capture, const CalibOptions& options,
                                   const Calibration& calibration,
                                   const std::vector<DetectedPhoto>& detected, int threads) {
  RegistrationProblem problem;
  FillPriors(capture, options, &problem);
  problem.sample_width_mm = capture.sample_size_mm[0];
  problem.sample_height_mm = capture.sample_size_mm[1];
  problem.margin = kSampleMargin;
  problem.may_have_moved = true;
  const std::vector<CalibratedPhoto>& photos = calibration.photos;
  const double pixel_mm = Longest_mm(capture) / constants::kRegistrationSide_px;
  const cv::Size size(
      static_cast<int>(std::lround(kSampleMargin * problem.sample_width_mm / pixel_mm)),
      static_cast<int>(std::lround(kSampleMargin * problem.sample_height_mm / pixel_mm)));
  problem.views.resize(photos.size());
  ForEachPiece(static_cast<int>(photos.size()), threads, [&](int piece) {
    const auto i = static_cast<size_t>(piece);
    problem.views[i] = TopViewOf(calibration.cameras[static_cast<size_t>(photos[i].camera)],
                                 photos[i], PictureOf(detected, photos[i]), size, pixel_mm);
  });
  return photos.size() < 2 ? Unregistered(problem) : RegisterSample(problem, threads);
}

bool LeaveOutOtherSamples(CalibSummary* summary) {
  const std::vector<size_t> flash = summary->FlashPhotos();
  const std::string reason =
      "shows another sample than " + NameList(Showing(0, *summary)) +
      ": nothing of its texture is in them, or it was turned by more than 5° or moved by more "
      "than a tenth of its side. Photograph each sample as a capture of its own";
  bool changed = false;
  for (size_t k = 0; k < summary->placement.textures.size(); ++k) {
    if (summary->placement.textures[k] != 1) continue;
    DetectedPhoto& photo = summary->photos[flash[k]];
    LeaveOut(reason, &photo);
    summary->left_out_before.push_back({photo.name, reason});
    changed = true;
  }
  return changed;
}

std::string OtherSamplesInWords(const CalibSummary& summary) {
  const std::vector<std::string> others = Showing(1, summary);
  if (others.empty()) return "";
  return fmt::format(
      "another sample than in {} is seen in {}: nothing of its texture is in the former, or it was "
      "turned by more than 5° or moved by more than a tenth of its side. Name them "
      "in [photos] left_out, and photograph each sample as a capture of its own",
      NameList(Showing(0, summary)), NameList(others));
}

std::string MovesInWords(const SampleRegistration& registration, const Calibration& calibration) {
  std::vector<std::string> names;
  double longest_mm = 0, largest_rad = 0;
  for (size_t i = 0; i < registration.moves.size(); ++i) {
    const SampleMove& move = registration.moves[i];
    if (move.none()) continue;
    names.push_back(calibration.photos[i].photo);
    longest_mm = std::max(longest_mm, move.shift_mm.norm());
    largest_rad = std::max(largest_rad, std::abs(move.turn_rad));
  }
  if (names.empty()) return "";
  constexpr double kWorthAWord_mm = 0.05, kWorthAWord_rad = 0.005;
  std::vector<std::string> how;
  if (longest_mm >= kWorthAWord_mm) how.push_back(fmt::format("lies up to {:.1f} mm", longest_mm));
  if (largest_rad >= kWorthAWord_rad) {
    how.push_back(fmt::format("is turned by {:.1f}°", Degrees(largest_rad)));
  }
  return fmt::format(
      "the sample was moved between photographs: in {} it {} from where the others have it. Each "
      "is "
      "used with the sample's place in it; fix the sample to the board with double-sided tape",
      NameList(names), fmt::join(how, " and "));
}

void PlaceSample(const SampleRegistration& registration, Calibration* calibration) {
  const Rigid3 board_from_sample = AssumedFromSample(registration.plane);
  calibration->board_from_sample = board_from_sample;
  for (size_t i = 0; i < calibration->photos.size(); ++i) {
    CalibratedPhoto& photo = calibration->photos[i];
    if (!registration.moves.empty()) {
      photo.camera_from_sample = photo.camera_from_sample * registration.moves[i].Motion();
    }
    photo.camera_from_sample = photo.camera_from_sample * board_from_sample;
    photo.registration = registration.homographies[i];
  }
}

Json PlacementMetrics(const CalibSummary& summary) {
  const SampleRegistration& placement = summary.placement;
  const auto sigma = [&](int i) { return std::sqrt(placement.plane_covariance(i, i)); };
  return {{"height_mm", placement.plane[0]},
          {"height_sd_mm", sigma(0)},
          {"slope", {placement.plane[1], placement.plane[2]}},
          {"slope_sd", {sigma(1), sigma(2)}},
          {"tilt_deg", Tilt_deg(placement.plane)},
          {"moved", MovesMetrics(summary)},
          {"told_by_texture", placement.told},
          {"windows", placement.windows},
          {"measured", placement.measured},
          {"displaced_before_mm", placement.displaced_before_mm},
          {"displaced_after_mm", placement.displaced_after_mm}};
}

std::string PlacementText(const CalibSummary& summary) {
  const SampleRegistration& placement = summary.placement;
  if (summary.calibration.photos.size() < 2 || summary.calibration.fixed_camera) return "";
  const std::string plane = summary.from_board() ? "the board" : "the plane of the model's points";
  if (!placement.told) {
    return fmt::format(
        "sample assumed to lie {:.2g} mm above {}: it has too little texture to estimate this from "
        "the photographs; measure its thickness and give [sample] height_mm\n",
        placement.plane[0], plane);
  }
  return fmt::format("sample lies {:.2f} ± {:.2f} mm {} {}, tilted by {:.1f}°\n",
                     std::abs(placement.plane[0]), placement.height_sd_mm(),
                     placement.plane[0] < 0 ? "below" : "above", plane, Tilt_deg(placement.plane));
}

}  // namespace glint
