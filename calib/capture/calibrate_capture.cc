#include "calib/capture/calibrate_capture.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "base/camera/orientation.h"
#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/board_file.h"
#include "base/parallel/parallel.h"
#include "calib/bundle/residual_picture.h"
#include "calib/capture/above_pose.h"
#include "calib/capture/assumed_camera.h"
#include "calib/capture/board_side.h"
#include "calib/capture/capture_chart.h"
#include "calib/capture/capture_light.h"
#include "calib/capture/colmap_poses.h"
#include "calib/capture/fixed_camera.h"
#include "calib/capture/guide_capture.h"
#include "calib/capture/phone_library.h"
#include "calib/capture/place_sample.h"
#include "calib/capture/pose_source.h"
#include "calib/capture/triage_photos.h"
#include "calib/chart/chart_picture.h"
#include "calib/guidance/coverage_picture.h"
#include "calib/guidance/polar_picture.h"
#include "calib/validation/consensus.h"
#include "calib/validation/misfit.h"

namespace glint {
namespace {

// Intrinsics of another calibration for the groups of this one, by the size of the stored picture.
void TakeIntrinsics(const CalibOptions& options, BundleProblem* problem, BundleOptions* bundle) {
  const Calibration known = ReadCalibration(options.fix_intrinsics);
  for (BundleCamera& camera : problem->cameras) {
    for (const Camera& candidate : known.cameras) {
      if (candidate.width_px != camera.width_px || candidate.height_px != camera.height_px)
        continue;
      camera.known = candidate;
      bundle->model = candidate.model;
      break;
    }
    if (camera.known) continue;
    throw UserError(options.fix_intrinsics, "data.cameras",
                    fmt::format("no camera of {}x{} pixels", camera.width_px, camera.height_px),
                    "give the calibration of the camera that took the photographs");
  }
  for (const BundleCamera& camera : problem->cameras) {
    if (camera.known->model != bundle->model) {
      throw UserError(options.fix_intrinsics, "data.cameras", "cameras of several models",
                      "calibrate all of them with one model");
    }
  }
}

// Intrinsics from the library, when it knows every camera; otherwise all are solved for.
void LookUpIntrinsics(const CalibOptions& options, const CalibSummary& summary,
                      BundleProblem* problem, BundleOptions* bundle) {
  std::vector<Camera> known;
  for (const CameraGroup& group : summary.groups.groups) {
    const DetectedPhoto& photo = summary.photos[group.photos[0]];
    const auto found = FindPhone(options.library, {photo.camera_model, photo.focal_length_35mm,
                                                   group.width_px, group.height_px});
    if (!found || (!known.empty() && known[0].model != found->camera.model)) {
      spdlog::info("{} does not know the camera '{}' at {}x{} pixels; its intrinsics are estimated",
                   options.library.string(), photo.camera_model, group.width_px, group.height_px);
      return;
    }
    spdlog::info("intrinsics of '{}' are those of {}", photo.camera_model, found->file.string());
    known.push_back(found->camera);
  }
  for (size_t c = 0; c < known.size(); ++c) problem->cameras[c].known = known[c];
  if (!known.empty()) bundle->model = known[0].model;
}

// What a bundle was adjusted with.
struct Adjusted {
  BundleProblem problem;
  BundleOptions options;
  std::optional<ModelChoice> choice;
};

// Fills summary->bundle.
Adjusted Adjust(const Capture& capture, const CalibOptions& options, BundleProblem problem,
                CalibSummary* summary) {
  BundleOptions bundle = BundleOptionsOf(options);
  if (!options.fix_intrinsics.empty()) {
    TakeIntrinsics(options, &problem, &bundle);
  } else if (!options.library.empty()) {
    LookUpIntrinsics(options, *summary, &problem, &bundle);
  }
  const bool quick = options.quick_px > 0;
  const bool given = !problem.cameras.empty() && problem.cameras[0].known;
  try {
    std::optional<ModelChoice> choice;
    if (options.model == "auto" && !given && !quick) choice = ChooseModel(problem, bundle);
    if (choice) bundle = WithModel(bundle, choice->model);
    summary->bundle = AdjustBundle(problem, bundle);
    return {std::move(problem), bundle, std::move(choice)};
  } catch (const UserError& error) {
    throw UserError(capture.file.string() + ": " + error.what());
  }
}

// Where too few photographs are left, the reason is why the others left.
Adjusted AdjustWhatIsLeft(const Capture& capture, const CalibOptions& options,
                          const BundleProblem& problem, CalibSummary* summary) {
  try {
    return Adjust(capture, options, problem, summary);
  } catch (const Error& error) {
    if (summary->left_out_before.empty()) throw;
    std::string reasons;
    for (const RejectedPhoto& photo : summary->left_out_before) {
      reasons += "\n  " + photo.name + ": " + photo.reason;
    }
    throw UserError(std::string(error.what()) + "\nLeft out before:" + reasons);
  }
}

// A print that is not to scale spoils nothing once its ruler is measured, but the person should
// know.
void TellOfPrintScale(const Board& board) {
  constexpr double kWorthAWord = 0.002;  // a ruler is read to some tenths of a millimetre
  if (std::abs(board.print_scale - 1) < kWorthAWord) return;
  spdlog::warn("the board was printed at {}; all its lengths are multiplied by {:.4f}",
               PrintScaleInWords(board), board.print_scale);
}

// Adds to a photograph's rejection what would make it go with the others, and says what the board
// looks like by all of them.
void ExplainMisfits(const CalibOptions& options, const BundleProblem& problem,
                    CalibSummary* summary) {
  const BoardStretch stretch = FindBoardStretch(problem, BundleOptionsOf(options), summary->bundle);
  if (stretch.relative != 0) {
    const std::string words = InWords(stretch);
    spdlog::warn("{}", words);
    summary->board_findings.push_back(words);
    return;  // photographs were rejected for that
  }
  for (PhotoEstimate& photo : summary->bundle.photos) {
    if (photo.rejected.empty()) continue;
    const auto view = ExplainByOtherView(summary->bundle, photo);
    if (view) photo.rejected += "; " + InWords(*view);
  }
}

// Which half of the photographs is right, geometry does not tell.
void TellOfSplit(CalibSummary* summary) {
  const auto& photos = summary->bundle.photos;
  const auto rejected = std::count_if(photos.begin(), photos.end(), [](const PhotoEstimate& photo) {
    return !photo.rejected.empty();
  });
  if (rejected < 2 || 2 * rejected < static_cast<std::ptrdiff_t>(photos.size())) return;
  const std::string words = fmt::format(
      "{} of {} photographs are inconsistent with the rest, so that the rest may be the wrong "
      "ones: an app may have cropped, straightened or enlarged some of them. Use the camera's own "
      "files",
      rejected, photos.size());
  spdlog::warn("{}", words);
  summary->board_findings.push_back(words);
}

// A focal length that is known to a hundredth only is worth a word.
void WarnOfUncertainty(const BundleResult& bundle) {
  for (const CameraEstimate& estimate : bundle.cameras) {
    if (estimate.photos == 0) continue;
    const double sigma = estimate.sigma[0] / estimate.camera.focal_length_x();
    if (sigma < 0.01) continue;
    spdlog::warn(
        "the focal length is uncertain by {:.1f} %; take photographs tilted by 20 to 40 degrees in "
        "several directions",
        100 * sigma);
  }
}

// The 35 mm equivalent is a whole number of millimetres; beyond that and the lens's own tolerance,
// one of the two is wrong, and it is mostly the board's description or EXIF after cropping.
void WarnOfToldFocal(const BundleProblem& problem, const BundleResult& bundle) {
  constexpr double kTolerance = 0.12;
  for (size_t c = 0; c < bundle.cameras.size(); ++c) {
    const double told_px = problem.cameras[c].told_focal_px;
    if (bundle.cameras[c].photos == 0 || told_px <= 0) continue;
    const double found_px = bundle.cameras[c].camera.focal_length_x();
    if (std::abs(found_px / told_px - 1) < kTolerance) continue;
    spdlog::warn(
        "EXIF's 35 mm equivalent gives a focal length of {:.0f} px, the board {:.0f} px; were the "
        "photographs cropped, or does the board differ from its description?",
        told_px, found_px);
  }
}

// Cameras of upright pictures: each group's own, then turned ones where a photograph is turned.
class UprightCameras {
 public:
  UprightCameras(const BundleResult& bundle, Calibration* calibration)
      : bundle_(bundle), calibration_(calibration) {
    for (size_t c = 0; c < bundle.cameras.size(); ++c) {
      if (bundle.cameras[c].photos > 0) Index(static_cast<int>(c), 0);
    }
  }
  int Index(int group, int turns) {
    const auto [at, added] =
        index_.insert({{group, turns}, static_cast<int>(calibration_->cameras.size())});
    if (added) {
      calibration_->cameras.push_back(TurnedCamera(bundle_.cameras[group].camera, turns));
    }
    return at->second;
  }

 private:
  const BundleResult& bundle_;
  Calibration* calibration_;
  std::map<std::pair<int, int>, int> index_;
};

// Cameras and poses of the flash photographs that are used.
Calibration PosesOf(const Capture& capture, const CalibSummary& summary) {
  Calibration calibration;
  const Eigen::Vector3d offset_mm(capture.light_offset_mm.data());
  UprightCameras cameras(summary.bundle, &calibration);
  for (const size_t i : summary.FlashPhotos()) {
    const DetectedPhoto& detected = summary.photos[i];
    const PhotoEstimate& estimate = summary.bundle.photos[summary.BundleIndex(i)];
    const int turns = summary.groups.turns[i];
    CalibratedPhoto photo;
    photo.photo = detected.name;
    photo.camera = cameras.Index(summary.groups.group[i], turns);
    photo.camera_from_sample = TurnedPose(estimate.camera_from_sample, turns);
    photo.light_in_camera_mm = TurnedCameraPoint(offset_mm, turns);
    photo.rms_px = estimate.rms_px;
    photo.corners = static_cast<int>(estimate.corners.size());
    photo.inliers = estimate.inliers();
    if (!detected.reduced) photo.blur_px = detected.measures.blur_px;
    calibration.photos.push_back(photo);
  }
  return calibration;
}

void FillPhotos(const Capture& capture, CalibSummary* summary) {
  Calibration poses = PosesOf(capture, *summary);
  summary->calibration.cameras = std::move(poses.cameras);
  summary->calibration.photos = std::move(poses.photos);
  for (size_t i = 0; i < summary->photos.size(); ++i) {
    const std::string reason = summary->ReasonLeftOut(i);
    if (reason.empty()) continue;
    summary->rejected.push_back({summary->photos[i].name, reason});
    spdlog::warn("{} is left out: {}", summary->photos[i].name, reason);
  }
  if (!summary->calibration.photos.empty()) return;
  std::string reasons;
  for (const RejectedPhoto& photo : summary->rejected) {
    reasons += "\n  " + photo.name + ": " + photo.reason;
  }
  throw ComputationError(capture.file.string() +
                         ": no flash photograph could be calibrated:" + reasons);
}

void WriteOutputs(const Capture& capture, const CalibSummary& summary, Stage* stage) {
  for (size_t c = 0; c < summary.bundle.cameras.size(); ++c) {
    if (summary.bundle.cameras[c].photos == 0) continue;
    WritePng(stage->Output(fmt::format("residuals_camera{}.png", c)),
             ResidualPicture(summary.bundle, static_cast<int>(c)));
  }
  if (const auto curve = ToneCurveOf(capture, summary)) {
    WriteResponseCurve(stage->Output(summary.calibration.tone_curve), *curve);
  }
  WriteLightPicture(summary, stage);
  if (summary.chart && !summary.chart->grey()) {
    WritePng(stage->Output("chart.png"),
             ChartPicture(summary.chart->chart, summary.chart->solution));
  }
  if (summary.from_board()) WriteTrustPictures(summary.bundle, summary.trust, stage);
  WriteFileAtomically(stage->Output("residuals.json"), ResidualsOf(summary).dump(1) + "\n");
  WriteFileAtomically(stage->Output("guidance_views.svg"), PolarPictureSvg(summary.guidance));
  WritePng(stage->Output("guidance_coverage.png"), CoveragePicture(summary.guidance));
}

// What follows from poses, side by side: how far they are known, the light, the sample's plane.
void InterpretBundle(const Capture& capture, const CalibOptions& options, Adjusted adjusted,
                     int threads, CalibSummary* summary) {
  const Calibration poses = PosesOf(capture, *summary);
  Trust trust;
  LightEstimate light;
  SampleRegistration placement;
  const bool quick = options.quick_px > 0;
  const std::array<std::function<void()>, 3> parts = {
      [&] {
        if (quick) {
          trust.diagnosis = DiagnoseBend(adjusted.problem, adjusted.options, summary->bundle);
          return;
        }
        trust = AssessTrust(capture, adjusted.problem, adjusted.options, summary->bundle);
      },
      [&] { light = EstimateBoardLight(capture, options, *summary); },
      [&] { placement = FindSamplePlane(capture, options, poses, summary->photos, threads); }};
  ForEachPiece(static_cast<int>(parts.size()), threads,
               [&](int part) { parts[static_cast<size_t>(part)](); });
  summary->trust = std::move(trust);
  if (!quick) summary->trust.choice = std::move(adjusted.choice);
  summary->light = std::move(light);
  summary->placement = std::move(placement);
}

// Needs summary->bundle and summary->placement.
void FinishCapture(const Capture& capture, const CalibOptions& options, bool assumed_intrinsics,
                   CalibSummary* summary) {
  FillPhotos(capture, summary);
  FillLight(capture, options, summary);
  for (const std::string& words :
       {OtherSamplesInWords(*summary), MovesInWords(summary->placement, summary->calibration)}) {
    if (words.empty()) continue;
    spdlog::warn("{}", words);
    summary->board_findings.push_back(words);
  }
  PlaceSample(summary->placement, &summary->calibration);
  summary->guidance = Judge(GuidanceInputOf(capture, *summary, assumed_intrinsics));
}

void FinishWithoutBundle(const Capture& capture, const CalibOptions& options,
                         bool assumed_intrinsics, int threads, CalibSummary* summary) {
  summary->placement =
      FindSamplePlane(capture, options, PosesOf(capture, *summary), summary->photos, threads);
  FinishCapture(capture, options, assumed_intrinsics, summary);
}

}  // namespace

std::string CalibSummary::ReasonLeftOut(size_t photo) const {
  const DetectedPhoto& detected = photos[photo];
  const int index = BundleIndex(photo);
  if (index < 0) return detected.detection.problem;
  if (!bundle.photos[index].rejected.empty()) return bundle.photos[index].rejected;
  if (!detected.board_photo && !detected.detection.position_known)
    return detected.detection.problem;
  return "";
}

std::vector<size_t> CalibSummary::FlashPhotos() const {
  std::vector<size_t> flash;
  for (size_t i = 0; i < photos.size(); ++i) {
    if (!photos[i].board_photo && ReasonLeftOut(i).empty()) flash.push_back(i);
  }
  return flash;
}

int CalibSummary::BundleIndex(size_t photo) const {
  const auto found = std::find(photo_index.begin(), photo_index.end(), photo);
  return found == photo_index.end() ? -1 : static_cast<int>(found - photo_index.begin());
}

std::vector<std::filesystem::path> CalibInputs(const Capture& capture,
                                               const CalibOptions& options) {
  std::vector<std::string> photos = capture.photos;
  photos.insert(photos.end(), capture.board_photos.begin(), capture.board_photos.end());
  std::vector<std::filesystem::path> inputs = capture.FilesBehind(photos);
  const ChartTable& chart = capture.chart;
  const bool listed = std::find(photos.begin(), photos.end(), chart.photo) != photos.end();
  if (chart.present() && !listed) inputs.push_back(capture.folder / chart.photo);
  if (chart.kind_is_file()) inputs.push_back(capture.folder / chart.kind);
  if (!capture.board_file.empty()) inputs.push_back(capture.folder / capture.board_file);
  if (!capture.lights.file.empty()) inputs.push_back(capture.folder / capture.lights.file);
  if (!options.fix_intrinsics.empty()) inputs.push_back(options.fix_intrinsics);
  if (!options.library.empty()) {
    for (const auto& file : LibraryFiles(options.library)) inputs.push_back(file);
  }
  if (PoseSourceOf(capture, options) == PoseSource::kColmapModel) {
    for (const auto& file : ColmapModelFiles(PosesFolder(capture, options))) inputs.push_back(file);
  }
  return inputs;
}

CalibSummary DetectCapture(const Capture& capture, const CalibOptions& options, int threads) {
  TellOfPrintScale(capture.board);
  CalibSummary summary;
  summary.photos = DetectPhotos(capture, options, threads);
  LeaveOutChartPhoto(capture, &summary.photos);
  summary.remarks = TriagePhotos(options, &summary.photos);
  for (const std::string& word : SettleBoardSides(capture, &summary.photos)) {
    spdlog::warn("{}", word);
    summary.board_findings.push_back(word);
  }
  if (const std::string words = ManySizesInWords(summary.photos); !words.empty()) {
    spdlog::warn("{}", words);
    summary.board_findings.push_back(words);
  }
  // Only the light tells to which side pixels were turned.
  summary.groups =
      GroupCameras(capture.file, options.cameras, summary.photos, options.light == "board");
  if (options.cameras == "auto") LeaveOutStrays(summary.groups, &summary.photos);
  RequireBoard(capture, options, summary.photos);
  return summary;
}

// Photographs that are inconsistent with most. A board that was printed higher than wide makes good
// ones leave, too.
bool LeaveOutOddPhotos(const Adjusted& adjusted, int threads, CalibSummary* summary) {
  const std::vector<OddPhoto> odd =
      OddPhotos(adjusted.problem, adjusted.options, summary->bundle, threads);
  if (odd.empty()) return false;
  if (FindBoardStretch(adjusted.problem, adjusted.options, summary->bundle).relative != 0) {
    return false;
  }
  for (const OddPhoto& one : odd) {
    DetectedPhoto& photo = summary->photos[summary->photo_index[one.photo]];
    LeaveOut(one.reason, &photo);
    summary->left_out_before.push_back({photo.name, one.reason});
  }
  return true;
}

// What its distortion lacks would seem to be the board's.
bool IsLensGiven(const BundleProblem& problem) {
  return std::any_of(problem.cameras.begin(), problem.cameras.end(),
                     [](const BundleCamera& camera) { return camera.known.has_value(); });
}

// Of a bend that the result takes into account. A sample of 100 mm that arches as a sheet of 250 mm
// does is turned by 0.4° at its edges where the sheet's middle is 1 mm high; less is worth no word.
void TellOfBend(CalibSummary* summary) {
  constexpr double kWorthAWord_mm = 1;
  const Diagnosis& diagnosis = summary->trust.diagnosis;
  if (!diagnosis.board_is_bent || !summary->bundle.bend) return;
  if (diagnosis.bend->height_mm.cwiseAbs().maxCoeff() < kWorthAWord_mm) return;
  const std::string words =
      diagnosis.words.front() + ", but the sample may be bent with it: glue both to something flat";
  spdlog::warn("{}", words);
  summary->board_findings.push_back(words);
}

void TellOfMisfit(CalibSummary* summary) {
  const std::string words = MisfitInWords(summary->trust.validation);
  if (words.empty()) return;
  spdlog::warn("{}", words);
  summary->board_findings.push_back(words);
}

void SolveCapture(const Capture& capture, const CalibOptions& given,
                  const std::vector<Camera>& assumed, int threads, CalibSummary* summary) {
  // Of odd photographs, the board's shape, and views that the light sets right.
  constexpr int kMostRounds = 5;
  CalibOptions options = given;  // with the board's shape as it is found
  BundleProblem problem;
  for (int round = 0; round <= kMostRounds; ++round) {
    summary->photo_index.clear();
    problem = MakeProblem(summary->photos, summary->groups, &summary->photo_index);
    for (size_t i = 0; i < assumed.size(); ++i) problem.cameras[i].known = assumed[i];
    Adjusted adjusted = AdjustWhatIsLeft(capture, options, problem, summary);
    const bool lens_is_free = !IsLensGiven(problem);
    if (round == 0 && lens_is_free && options.quick_px == 0 &&
        LeaveOutOddPhotos(adjusted, threads, summary)) {
      continue;
    }
    InterpretBundle(capture, options, std::move(adjusted), threads, summary);
    if (round == kMostRounds) break;
    const bool bent =
        options.board_shape == "auto" && lens_is_free && summary->trust.diagnosis.board_is_bent;
    if (bent) options.board_shape = "bent";
    // Each by the indices of this round, what the light says first.
    if (!bent && !FollowLight(summary) && !LeaveOutOtherSamples(summary)) break;
  }
  TellOfBend(summary);
  TellOfMisfit(summary);
  ExplainMisfits(options, problem, summary);
  TellOfSplit(summary);
  WarnOfUncertainty(summary->bundle);
  if (assumed.empty()) WarnOfToldFocal(problem, summary->bundle);
  FinishCapture(capture, options, !assumed.empty(), summary);
}

void SolveWithAssumedCameras(const Capture& capture, const CalibOptions& options, int threads,
                             CalibSummary* summary) {
  const CameraModel model = CameraModelFromName(options.model).value_or(CameraModel::kOpenCv);
  std::vector<Camera> assumed;
  for (const CameraGroup& group : summary->groups.groups) {
    assumed.push_back(AssumedCamera(summary->photos, group, model));
  }
  summary->calibration = Calibration();
  summary->rejected.clear();
  SolveCapture(capture, options, assumed, threads, summary);
}

namespace {

// One photograph seldom determines the focal length: it then comes from EXIF, or is that of phones.
void SolveOnePhotograph(const Capture& capture, const CalibOptions& options, int threads,
                        CalibSummary* summary) {
  try {
    SolveCapture(capture, options, {}, threads, summary);
  } catch (const Error& error) {
    const CameraGroup& group = summary->groups.groups[0];
    spdlog::warn(
        "one photograph does not determine the focal length; {} is used, which may be off by a few "
        "per cent, and distances with it. Take two more, tilted by 20 to 40 degrees",
        ReportedFocal_px(summary->photos, group) > 0
            ? "EXIF's 35 mm equivalent"
            : "that of a phone's main camera (26 mm equivalent)");
    spdlog::debug("{}", error.what());
    SolveWithAssumedCameras(capture, options, threads, summary);
  }
}

}  // namespace

CalibSummary CalibrateCapture(const Capture& capture, const CalibOptions& options,
                              const CommonOptions& common, Stage* stage) {
  CalibSummary summary;
  const PoseSource source = PoseSourceOf(capture, options);
  if (source == PoseSource::kFixedCamera) {
    CalibrateFixedCamera(capture, options, common.threads, &summary);
  } else if (source == PoseSource::kBoard) {
    summary = DetectCapture(capture, options, common.threads);
    const bool given = !options.fix_intrinsics.empty() || !options.library.empty();
    if (summary.photos.size() == 1 && !given) {
      SolveOnePhotograph(capture, options, common.threads, &summary);
    } else {
      SolveCapture(capture, options, {}, common.threads, &summary);
    }
  } else if (source == PoseSource::kAbove) {
    summary.photos = DetectPhotos(WithoutChartPhoto(capture), options, common.threads);
    PoseFromAbove(capture, options, &summary);
    FinishWithoutBundle(capture, options, true, common.threads, &summary);
  } else {
    summary.photos = DetectPhotos(capture, options, common.threads);
    PosesFromColmap(capture, options, common, stage, &summary);
    FinishWithoutBundle(capture, options, false, common.threads, &summary);
  }
  CorrectColours(capture, &summary);
  WriteOutputs(capture, summary, stage);
  stage->Commit(ToJson(summary.calibration), MetricsOf(summary));
  return summary;
}

}  // namespace glint
