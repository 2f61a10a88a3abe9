#include "datasets/looks/looks.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "base/reflectance/log_radiance.h"
#include "base/statistics/quantile.h"
#include "datasets/looks/view_error.h"
#include "fitting/photographs/photographs.h"

namespace glint {
namespace {

constexpr int kComparedWidth = 256;  // whose texels the bands are counted in
constexpr double kGamma = 2.2;
constexpr int kClippedFrom = 252;  // of 255; what is brighter may be clipped
constexpr double kHighlightShare = 0.02;
// Deviation of log luminance below which a band is rounding error: one texel in a hundred thousand
// that differs by one step of 8 bits has as much.
constexpr double kLeastDeviation = 1e-5;

// By 8-bit value.
using ValueTable = std::array<double, 256>;

ValueTable RadianceTable() {
  ValueTable table;
  for (size_t i = 0; i < table.size(); ++i) {
    table[i] = std::pow(static_cast<double>(i) / 255, kGamma);
  }
  return table;
}

ValueTable LogTable() {
  ValueTable table = RadianceTable();
  for (double& value : table) value = std::log(value + kLogOffset);
  return table;
}

// What a screen shows of radiance, by a table: a power for every sample takes as long as all else.
class ScreenValues {
 public:
  ScreenValues() {
    for (size_t value = 0; value < 255; ++value) {
      next_[value] = static_cast<float>(std::pow((static_cast<double>(value) + 0.5) / 255, kGamma));
    }
    next_[255] = std::numeric_limits<float>::infinity();
    unsigned char value = 0;
    for (size_t cell = 0; cell < first_.size(); ++cell) {
      const double root = static_cast<double>(cell) / kCells;
      while (next_[value] <= root * root) ++value;
      first_[cell] = value;
    }
  }
  // 0 also of what is no number.
  unsigned char Of(float radiance) const {
    if (!(radiance > 0)) return 0;
    if (radiance >= 1) return 255;
    unsigned char value = first_[static_cast<size_t>(std::sqrt(radiance) * kCells)];
    while (next_[value] <= radiance) ++value;
    return value;
  }

 private:
  static constexpr int kCells = 1024;
  std::array<float, 256> next_;                  // radiance from which the next value is shown
  std::array<unsigned char, kCells + 1> first_;  // by the radiance's root
};

struct ScreenPictures {
  cv::Mat photograph, rendered;  // CV_8UC3, RGB
};

ScreenPictures ShownOnScreen(std::span<const float> rendered, const RectifiedImage& photograph,
                             const std::vector<bool>& told) {
  const size_t texels = told.size();
  const ScreenValues values;
  ScreenPictures pictures;
  pictures.photograph.create(photograph.height, photograph.width, CV_8UC3);
  pictures.rendered.create(photograph.height, photograph.width, CV_8UC3);
  for (size_t i = 0; i < texels; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const unsigned char ours = values.Of(rendered[c * texels + i]);
      pictures.rendered.data[3 * i + c] = ours;
      pictures.photograph.data[3 * i + c] =
          told[i] ? values.Of(photograph.rgb[c * texels + i]) : ours;
    }
  }
  return pictures;
}

// Residuals of one channel, sorted, and how often each occurs.
struct Residual {
  double value;
  size_t count;
};

double ValueAt(const std::vector<Residual>& residuals, size_t rank) {
  for (const Residual& residual : residuals) {
    if (rank < residual.count) return residual.value;
    rank -= residual.count;
  }
  return 0;
}

double SumAboutMedian(const std::vector<Residual>& residuals, size_t count) {
  const double median = (ValueAt(residuals, (count - 1) / 2) + ValueAt(residuals, count / 2)) / 2;
  double sum = 0;
  for (const Residual& residual : residuals) {
    sum += static_cast<double>(residual.count) * std::abs(residual.value - median);
  }
  return sum;
}

// From how often each pair of 8-bit values occurs: of large pictures there are fewer pairs than
// texels.
double FreeLogL1(const ScreenPictures& pictures, const std::vector<bool>& told) {
  const ValueTable log = LogTable();
  const auto* photograph = pictures.photograph.ptr<cv::Vec3b>();
  const auto* rendered = pictures.rendered.ptr<cv::Vec3b>();
  std::array<std::vector<size_t>, 3> pairs;
  for (auto& counts : pairs) counts.resize(log.size() * log.size());
  size_t texels = 0;
  for (size_t i = 0; i < told.size(); ++i) {
    const cv::Vec3b &theirs = photograph[i], &ours = rendered[i];
    if (!told[i] || std::max({theirs[0], theirs[1], theirs[2]}) >= kClippedFrom) continue;
    ++texels;
    for (int c = 0; c < 3; ++c) ++pairs[c][theirs[c] * log.size() + ours[c]];
  }
  if (texels == 0) return Looks::kUnknown;
  double sum = 0;
  for (const auto& counts : pairs) {
    std::vector<Residual> residuals;
    for (size_t pair = 0; pair < counts.size(); ++pair) {
      if (counts[pair] == 0) continue;
      residuals.push_back({log[pair / log.size()] - log[pair % log.size()], counts[pair]});
    }
    std::sort(residuals.begin(), residuals.end(),
              [](const Residual& a, const Residual& b) { return a.value < b.value; });
    sum += SumAboutMedian(residuals, texels);
  }
  return sum / (3.0 * static_cast<double>(texels));
}

cv::Mat LogLuminance(const cv::Mat& picture) {
  const ValueTable log = LogTable();
  cv::Mat luminance(picture.size(), CV_32F);
  const auto* pixels = picture.ptr<cv::Vec3b>();
  for (size_t i = 0; i < picture.total(); ++i) {
    const cv::Vec3b& pixel = pixels[i];
    luminance.ptr<float>()[i] =
        static_cast<float>((log[pixel[0]] + log[pixel[1]] + log[pixel[2]]) / 3);
  }
  return luminance;
}

// Detail of 1 to 2 texels, 2 to 4, …, a texel being `scale` of the picture's. What is blurred by
// many texels is as well described by half as many: so many have the coarse bands of large
// pictures, whose blurs would else take most of the time.
std::vector<cv::Mat> Bands(cv::Mat smooth, double scale, size_t count) {
  constexpr double kBlurredEnough_px = 8;
  const double width = smooth.cols, height = smooth.rows;
  std::vector<cv::Mat> bands;
  double blurred = 0;
  for (double sigma = scale; bands.size() < count; sigma *= 2) {
    if (smooth.cols > 2 * kComparedWidth && blurred * smooth.cols / width >= kBlurredEnough_px) {
      cv::Mat half;
      cv::resize(smooth, half, {(smooth.cols + 1) / 2, (smooth.rows + 1) / 2}, 0, 0,
                 cv::INTER_AREA);
      smooth = half;
    }
    cv::Mat smoother;
    cv::GaussianBlur(smooth, smoother, {0, 0}, sigma * smooth.cols / width,
                     sigma * smooth.rows / height);
    bands.emplace_back(smooth - smoother);
    smooth = smoother;
    blurred = sigma;
  }
  return bands;
}

double StandardDeviation(const cv::Mat& band) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(band, mean, deviation);
  return deviation[0];
}

std::array<double, 4> BandDeviations(const cv::Mat& picture) {
  std::array<double, 4> deviations{};
  const double scale = static_cast<double>(picture.cols) / kComparedWidth;
  const std::vector<cv::Mat> bands = Bands(LogLuminance(picture), scale, deviations.size());
  for (size_t i = 0; i < bands.size(); ++i) deviations[i] = StandardDeviation(bands[i]);
  return deviations;
}

std::array<double, 4> ContrastOf(const ScreenPictures& pictures) {
  const auto photograph = BandDeviations(pictures.photograph);
  const auto rendered = BandDeviations(pictures.rendered);
  std::array<double, 4> contrast{};
  for (size_t i = 0; i < contrast.size(); ++i) {
    contrast[i] = photograph[i] < kLeastDeviation ? Looks::kUnknown : rendered[i] / photograph[i];
  }
  return contrast;
}

// How far pictures are shifted against each other, and what is left out along each side for it:
// as far as the blur of the edges reaches, too.
struct ShiftRange {
  int reach = 3;
  int margin() const { return 3 * reach + 5; }
};

// Reach below 0: the picture is too small.
ShiftRange ShiftsWithin(const cv::Size& size) {
  constexpr int kLeastCompared = 6;
  ShiftRange range;
  while (range.reach >= 0 &&
         std::min(size.width, size.height) < kLeastCompared + 2 * range.margin()) {
    --range.reach;
  }
  return range;
}

double BestCorrelation(const cv::Mat& photograph, const cv::Mat& rendered,
                       const ShiftRange& range) {
  if (range.reach < 0 || StandardDeviation(photograph) < kLeastDeviation) return Looks::kUnknown;
  const int margin = range.margin();
  const cv::Rect middle(margin, margin, photograph.cols - 2 * margin, photograph.rows - 2 * margin);
  const cv::Mat still = photograph(middle);
  const auto count = static_cast<double>(still.total());
  const double square = still.dot(still) / count;
  double best = -1;
  for (int down = -range.reach; down <= range.reach; ++down) {
    for (int across = -range.reach; across <= range.reach; ++across) {
      const cv::Mat moved = rendered(middle - cv::Point(across, down));
      // So that what has no detail is not like anything.
      constexpr double kLeast = 1e-12;
      const double both = square * moved.dot(moved) / count + kLeast;
      best = std::max(best, still.dot(moved) / count / std::sqrt(both));
    }
  }
  return best;
}

cv::Mat AtMostComparedWidth(const cv::Mat& picture) {
  if (picture.cols <= kComparedWidth) return picture;
  const long height =
      std::lround(static_cast<double>(kComparedWidth) * picture.rows / picture.cols);
  cv::Mat small;
  cv::resize(picture, small, {kComparedWidth, std::max(1, static_cast<int>(height))}, 0, 0,
             cv::INTER_AREA);
  return small;
}

std::array<double, 3> CorrelationOf(const ScreenPictures& pictures) {
  std::array<double, 3> correlation{};
  const cv::Mat small = AtMostComparedWidth(pictures.photograph);
  const ShiftRange range = ShiftsWithin(small.size());
  const auto photograph = Bands(LogLuminance(small), 1, correlation.size());
  const auto rendered =
      Bands(LogLuminance(AtMostComparedWidth(pictures.rendered)), 1, correlation.size());
  for (size_t i = 0; i < correlation.size(); ++i) {
    correlation[i] = BestCorrelation(photograph[i], rendered[i], range);
  }
  return correlation;
}

constexpr int kWindow = 11;  // of structural similarity

// Local similarity summed over the rows `kept` of two grey pictures.
double SimilaritySum(const cv::Mat& photograph, const cv::Mat& rendered, const cv::Range& kept) {
  constexpr double kLuminance = 6.5, kContrast = 58.5;  // (0.01 · 255)² and (0.03 · 255)²
  cv::Mat a, b;
  photograph.convertTo(a, CV_32F);
  rendered.convertTo(b, CV_32F);
  const auto window_mean = [](const cv::Mat& of) {
    cv::Mat mean;
    cv::GaussianBlur(of, mean, {kWindow, kWindow}, 1.5);
    return mean;
  };
  const cv::Mat mean_a = window_mean(a), mean_b = window_mean(b);
  const cv::Mat square_a = mean_a.mul(mean_a), square_b = mean_b.mul(mean_b);
  const cv::Mat product = mean_a.mul(mean_b);
  const cv::Mat variances = window_mean(a.mul(a)) - square_a + window_mean(b.mul(b)) - square_b;
  const cv::Mat covariance = window_mean(a.mul(b)) - product;
  const cv::Mat above = (2 * product + kLuminance).mul(2 * covariance + kContrast);
  const cv::Mat below = (square_a + square_b + kLuminance).mul(variances + kContrast);
  const cv::Mat similarity = above / below;
  return cv::sum(similarity.rowRange(kept))[0];
}

// By strips of rows, since it takes some twenty planes of floats.
double SsimOf(const ScreenPictures& pictures) {
  constexpr int kRows = 64, kAround = kWindow / 2;
  cv::Mat photograph, rendered;
  cv::cvtColor(pictures.photograph, photograph, cv::COLOR_RGB2GRAY);
  cv::cvtColor(pictures.rendered, rendered, cv::COLOR_RGB2GRAY);
  double sum = 0;
  for (int row = 0; row < photograph.rows; row += kRows) {
    const int end = std::min(photograph.rows, row + kRows);
    const cv::Range read(std::max(0, row - kAround), std::min(photograph.rows, end + kAround));
    sum += SimilaritySum(photograph.rowRange(read), rendered.rowRange(read),
                         {row - read.start, end - read.start});
  }
  return sum / static_cast<double>(photograph.total());
}

double HighlightOf(const ScreenPictures& pictures) {
  const ValueTable radiance = RadianceTable();
  const auto luminance = [&radiance](const cv::Mat& picture, size_t i) {
    const cv::Vec3b& pixel = picture.ptr<cv::Vec3b>()[i];
    return (radiance[pixel[0]] + radiance[pixel[1]] + radiance[pixel[2]]) / 3;
  };
  std::vector<double> photograph(pictures.photograph.total());
  for (size_t i = 0; i < photograph.size(); ++i) photograph[i] = luminance(pictures.photograph, i);
  const double bright = Quantile(photograph, 1 - kHighlightShare);
  double theirs = 0, ours = 0;
  for (size_t i = 0; i < photograph.size(); ++i) {
    if (photograph[i] < bright) continue;
    theirs += photograph[i];
    ours += luminance(pictures.rendered, i);
  }
  return theirs > 0 ? ours / theirs : Looks::kUnknown;
}

}  // namespace

Looks CompareLooks(std::span<const float> rendered, const RectifiedImage& photograph, bool ldr) {
  const size_t texels = photograph.mask.size();
  if (rendered.size() != 3 * texels || photograph.rgb.size() != 3 * texels) {
    throw std::invalid_argument("rendering and photograph must have one size");
  }
  const std::vector<bool> told = ToldTexels(photograph, ldr);
  if (std::find(told.begin(), told.end(), true) == told.end()) return {};
  const ScreenPictures pictures = ShownOnScreen(rendered, photograph, told);
  Looks looks;
  looks.free = FreeLogL1(pictures, told);
  looks.contrast = ContrastOf(pictures);
  looks.correlation = CorrelationOf(pictures);
  looks.ssim = SsimOf(pictures);
  looks.highlight = HighlightOf(pictures);
  return looks;
}

}  // namespace glint
