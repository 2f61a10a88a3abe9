#include "calib/capture/capture_chart.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors/errors.h"
#include "base/photos/photo.h"
#include "calib/capture/capture_light.h"
#include "calib/chart/read_chart.h"

namespace glint {
namespace {

// Above it the patches are not those of the reference, or the light and the curve not as assumed:
// careful charts of phones end between 1 and 2 ΔE.
constexpr double kSuspect = 3;
// Farther off than a camera is without any correction: it would do harm.
constexpr double kHopeless = 10;
// A patch of fewer pixels is a dozen or less across its middle, where the lens's blur mixes in its
// neighbours.
constexpr int kFewPixels = 36;
constexpr double kPaperTint = 0.10;

Encoding EncodingOfChart(const Capture& capture, const CalibSummary& summary,
                         const std::filesystem::path& file, const Photo& photo) {
  if (!photo.is_float() && photo.format != "raw") {
    if (const auto curve = ToneCurveOf(capture, summary)) return Encoding(*curve);
  }
  return ResolveEncoding(capture.resolved_encoding(), file, photo);
}

ChartCorners CornersFromTable(const ChartTable& table) {
  ChartCorners corners;
  for (size_t i = 0; i < 4; ++i) {
    corners[i] = {table.corners_px[2 * i], table.corners_px[2 * i + 1]};
  }
  return corners;
}

double AspectOf(const ChartCorners& c) {
  return ((c[1] - c[0]).norm() + (c[2] - c[3]).norm()) /
         ((c[3] - c[0]).norm() + (c[2] - c[1]).norm());
}

Chart ChartOf(const Capture& capture, const ChartCorners& corners) {
  const ChartTable& table = capture.chart;
  if (table.kind == kGreyCard) return GreyCard(table.reflectance);
  if (table.kind_is_file()) {
    return ReadChartCsv(capture.folder / table.kind, table.illuminant, AspectOf(corners));
  }
  return ChartOfKind(table.kind).value();
}

// Its white balance over that of the first photograph; ones where it is not among the calibrated.
Eigen::Vector3d WhiteBalanceOf(const CalibSummary& summary, const std::string& photo,
                               bool* calibrated) {
  for (const CalibratedPhoto& one : summary.calibration.photos) {
    if (one.photo != photo) continue;
    *calibrated = true;
    return one.white_balance_rgb;
  }
  *calibrated = false;
  return Eigen::Vector3d::Ones();
}

void RequireReadings(const Capture& capture, const ChartResult& result, size_t least) {
  const size_t usable = UsableCount(result.readings);
  if (usable >= least) return;
  const bool outside = std::any_of(result.readings.begin(), result.readings.end(),
                                   [](const PatchReading& r) { return !r.inside; });
  throw UserError(capture.file, "chart",
                  fmt::format("{} usable patches of {} in {} (left out: {}); {} are needed", usable,
                              result.readings.size(), result.photo,
                              NamesOfLeftOut(result.chart, result.readings), least),
                  outside ? "correct corners_px, or photograph the whole chart"
                          : "expose the chart's photograph less, so that nothing in it clips");
}

constexpr const char* kCauses =
    "check [chart] kind and corners_px, [radiometry] encoding (a phone's tone curve), and that the "
    "flash alone lit the chart, without its mirror image in it";

// Corners that were given from another one than the chart's top left fit far better when they are
// turned: they are, and it is said. What then fits badly is doubted, or refused.
void Doubt(const Capture& capture, const ChartReader& reader, ChartResult* result) {
  if (result->solution.HeldOutMean() <= kSuspect) return;
  const auto turned = reader.BestTurn(*result);
  if (turned && turned->solution.HeldOutMean() <= kSuspect) {
    *result = *turned;
    result->findings.push_back(
        fmt::format("{}: judging by its colours, the chart's top left is at ({:.0f}, {:.0f}): list "
                    "that corner first in [chart] corners_px",
                    result->photo, result->corners_px[0].x(), result->corners_px[0].y()));
    return;
  }
  const std::string off = fmt::format(
      "colours of the chart's held-out patches that are off by {:.1f} dE00 in the mean "
      "after the correction",
      result->solution.HeldOutMean());
  if (result->solution.HeldOutMean() > kHopeless) {
    throw UserError(capture.folder / result->photo, "chart", off, kCauses);
  }
  result->findings.push_back(fmt::format("{}: {}; {}", result->photo, off, kCauses));
}

void AddFindings(ChartResult* result) {
  const std::string left_out = NamesOfLeftOut(result->chart, result->readings);
  if (!left_out.empty()) {
    result->findings.push_back(
        fmt::format("{}: patches of the chart that clip or lie outside the photograph are left "
                    "out: {}",
                    result->photo, left_out));
  }
  int fewest = result->readings[0].pixels;
  for (const PatchReading& reading : result->readings) {
    if (reading.usable()) fewest = std::min(fewest, reading.pixels);
  }
  if (fewest < kFewPixels) {
    result->findings.push_back(
        fmt::format("{}: a patch of the chart is read from only {} pixels; move closer",
                    result->photo, fewest));
  }
}

ChartResult LocateChart(const Capture& capture, const Photo& photo, const Encoding& encoding) {
  const ChartTable& table = capture.chart;
  ChartResult result;
  result.photo = table.photo;
  if (!table.corners_px.empty()) {
    result.corners_px = CornersFromTable(table);
  } else {
    const auto found = FindChart(photo, encoding.kind() == Encoding::kLinear, table.kind);
    if (!found) {
      throw UserError(capture.folder / table.photo, "chart", fmt::format("no {} chart", table.kind),
                      "check [chart] kind in capture.toml, photograph the whole chart large and "
                      "evenly lit, or give its position: corners_px");
    }
    result.corners_px = *found;
    result.found = true;
  }
  result.chart = ChartOf(capture, result.corners_px);
  return result;
}

void SolveLocated(const Capture& capture, const ChartReader& reader, ChartResult* result) {
  reader.Measure(result);
  if (result->grey()) {
    RequireReadings(capture, *result, 1);
    if (result->readings[0].rgb.minCoeff() <= 0) {
      throw UserError(capture.file, "chart.corners_px", "a card with a channel that is black",
                      "give the corners of the grey card");
    }
    result->solution = SolveGreyCard(result->chart, result->readings[0]);
    return;
  }
  const ColourModel model = ColourModelFromName(capture.chart.model).value();
  RequireReadings(capture, *result, static_cast<size_t>(FewestPatches(model)));
  // A pattern that was found may be turned; corners that were given are as they are.
  auto best = result->found ? reader.BestTurn(*result) : reader.TurnedBy(*result, 0);
  if (!best) {
    throw UserError(capture.file, "chart",
                    "colours in " + result->photo + " that no correction maps to the chart's",
                    "check [chart] kind and corners_px");
  }
  *result = *std::move(best);
  Doubt(capture, reader, result);
}

// See the header: the paper's white where a photograph of its own contradicts it.
void SettleWhite(const CalibSummary& summary, ChartResult* result) {
  const bool paper_tells =
      summary.power_source == "board" || summary.power_source == "board, light at the lens";
  if (!paper_tells) return;
  Eigen::Vector3d ratio = result->solution.white_rgb.cwiseQuotient(summary.calibration.light_rgb);
  ratio /= ratio.y();
  const double off = ratio.maxCoeff() / ratio.minCoeff() - 1;
  if (off <= kPaperTint) return;
  const std::string finding = fmt::format(
      "{}: its white differs from the board's paper by {:.0f} % between channels, as if automatic "
      "white balance had changed",
      result->photo, 100 * off);
  if (result->grey()) {
    result->findings.push_back(finding + "; fix the white balance, or leave [chart] out");
    return;
  }
  result->solution.correction = result->solution.correction.After(ratio);
  result->white_from = "paper";
  result->findings.push_back(finding +
                             "; the paper's white is used: fix the white balance, or photograph "
                             "the chart together with the board");
}

}  // namespace

void CorrectColours(const Capture& capture, CalibSummary* summary) {
  if (!capture.chart.present()) return;
  const std::filesystem::path file = capture.folder / capture.chart.photo;
  Photo photo = ReadPhoto(file);
  const Encoding encoding = EncodingOfChart(capture, *summary, file, photo);
  ChartResult result = LocateChart(capture, photo, encoding);
  const LinearPhoto linear(std::move(photo), encoding);
  bool calibrated = false;
  const Eigen::Vector3d balance = WhiteBalanceOf(*summary, result.photo, &calibrated);
  const ChartReader reader(linear, balance,
                           ColourModelFromName(capture.chart.model).value_or(ColourModel::kLinear));
  SolveLocated(capture, reader, &result);
  AddFindings(&result);
  if (!calibrated) SettleWhite(*summary, &result);
  for (const std::string& finding : result.findings) spdlog::warn("{}", finding);
  summary->calibration.colour_correction = result.solution.correction;
  summary->chart = std::move(result);
}

void LeaveOutChartPhoto(const Capture& capture, std::vector<DetectedPhoto>* photos) {
  if (!capture.chart.present() || photos->size() < 2) return;
  std::erase_if(*photos, [&](const DetectedPhoto& photo) {
    return photo.name == capture.chart.photo && photo.detection.corners.empty();
  });
}

Capture WithoutChartPhoto(const Capture& capture) {
  Capture without = capture;
  if (without.photos.size() > 1) std::erase(without.photos, capture.chart.photo);
  return without;
}

}  // namespace glint
