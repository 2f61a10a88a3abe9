#include "fitting/relief/relief_slopes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

#include "base/parallel/parallel.h"

namespace glint {
namespace {

bool IsEvenAndSmooth(int n) {
  if (n % 2 != 0) return false;
  for (const int factor : {2, 3, 5}) {
    while (n % factor == 0) n /= factor;
  }
  return n == 1;
}

// cv::dct takes even sizes alone, and others than such products slowly.
int TileSide(int length) {
  int side = std::min(length, kMostTileSide);
  while (side > 0 && !IsEvenAndSmooth(side)) --side;
  return side;
}

// Cosine transforms of a tile, or their inverses. Along an axis of which slopes are derivatives
// they are odd: their sine transform's k-th coefficient is the (N − k)-th of the cosine transform
// of values with every other sign turned.
class SlopeTransform {
 public:
  // `odd`: 0: across, 1: down.
  explicit SlopeTransform(int odd) : odd_(odd) {}
  cv::Mat Forward(const cv::Mat& values) const {
    cv::Mat spectrum;
    cv::dct(WithSigns(values), spectrum);
    return Reversed(spectrum);
  }
  cv::Mat Inverse(const cv::Mat& spectrum) const {
    cv::Mat values;
    cv::dct(Reversed(spectrum), values, cv::DCT_INVERSE);
    return WithSigns(values);
  }

 private:
  cv::Mat WithSigns(cv::Mat values) const {
    values = values.clone();
    for (int y = 0; y < values.rows; ++y) {
      for (int x = 0; x < values.cols; ++x) {
        if ((odd_ == 0 ? x : y) % 2 != 0) values.at<double>(y, x) *= -1;
      }
    }
    return values;
  }
  // The k-th to the (N − k)-th; the 0-th, of which a height has nothing, stays 0.
  cv::Mat Reversed(const cv::Mat& spectrum) const {
    cv::Mat reversed = cv::Mat::zeros(spectrum.size(), CV_64F);
    for (int y = odd_; y < spectrum.rows; ++y) {
      for (int x = 1 - odd_; x < spectrum.cols; ++x) {
        reversed.at<double>(y, x) = odd_ == 0 ? spectrum.at<double>(y, spectrum.cols - x)
                                              : spectrum.at<double>(spectrum.rows - y, x);
      }
    }
    return reversed;
  }
  int odd_;
};

// Of slopes across and down by frequency, as they were found.
class Spectrum {
 public:
  Spectrum(const cv::Mat& across, const cv::Mat& down)
      : across_(SlopeTransform(0).Forward(across)), down_(SlopeTransform(1).Forward(down)) {
    const size_t rings = 1 + static_cast<size_t>(std::max(across.rows, across.cols) / kRingWidth);
    curl_.assign(rings, 0);
    rest_.assign(rings, 0);
    ForEach([&](const Frequency& at, double& p, double& q) {
      // Along the axes there is one slope alone, which has no curl: ribs and joints, which people
      // lay straight, count as relief. Without them, their rings lose what they have.
      const double curl = at.x * q - at.y * p, rest = at.x * p + at.y * q;
      curl_[at.ring] += curl * curl;
      rest_[at.ring] += rest * rest;
    });
  }

  // The same of a height field.
  std::array<cv::Mat, 2> OfRelief(double facet_variance) {
    const double curl =
        std::accumulate(curl_.begin(), curl_.end(), 0.0) / static_cast<double>(across_.total());
    const double errors = curl > facet_variance ? 1 - facet_variance / curl : 0;
    ForEach([&](const Frequency& at, double& p, double& q) {
      const double rest = Gain(at.ring, errors) * (at.x * p + at.y * q);
      p = at.x * rest;
      q = at.y * rest;
    });
    return {SlopeTransform(0).Inverse(across_), SlopeTransform(1).Inverse(down_)};
  }

 private:
  struct Frequency {
    double x, y;  // its direction
    size_t ring;
  };
  double Gain(size_t ring, double errors) const {
    const double noise = errors * curl_[ring];
    return rest_[ring] > noise ? 1 - noise / rest_[ring] : 0;
  }
  template <class Visit>
  void ForEach(const Visit& visit) {
    const int longer = std::max(across_.rows, across_.cols);
    for (int y = 0; y < across_.rows; ++y) {
      for (int x = y == 0 ? 1 : 0; x < across_.cols; ++x) {
        const double u = static_cast<double>(x) / across_.cols;
        const double v = static_cast<double>(y) / across_.rows;
        const double length = std::hypot(u, v);
        const auto ring = static_cast<size_t>(length * longer / kRingWidth);
        visit(Frequency{u / length, v / length, std::min(ring, curl_.size() - 1)},
              across_.at<double>(y, x), down_.at<double>(y, x));
      }
    }
  }

  cv::Mat across_, down_;
  std::vector<double> curl_, rest_;  // powers by ring
};

// Of a plane of `width` values a row.
cv::Mat PartOf(std::span<const float> plane, int width, const cv::Rect& place) {
  cv::Mat part(place.height, place.width, CV_64F);
  for (int y = 0; y < place.height; ++y) {
    const size_t first = static_cast<size_t>(place.y + y) * static_cast<size_t>(width) +
                         static_cast<size_t>(place.x);
    std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(first), place.width,
                part.ptr<double>(y));
  }
  return part;
}

// With its share in each texel, to the rows asked for.
void AddTile(const cv::Mat& tile, const TiledAxis& across, int column_tile, const TiledAxis& down,
             int row_tile, RowSpan asked, std::vector<float>* plane) {
  const int left = across.first(column_tile), top = down.first(row_tile);
  const size_t width = plane->size() / static_cast<size_t>(asked.last - asked.first);
  std::vector<double> shares;
  for (int x = 0; x < tile.cols; ++x) shares.push_back(across.Share(column_tile, left + x));
  const int last = std::min(top + tile.rows, asked.last);
  for (int row = std::max(top, asked.first); row < last; ++row) {
    const double share = down.Share(row_tile, row);
    const double* values = tile.ptr<double>(row - top);
    float* to = plane->data() + static_cast<size_t>(row - asked.first) * width + left;
    for (size_t x = 0; x < shares.size(); ++x) {
      to[x] += static_cast<float>(share * shares[x] * values[x]);
    }
  }
}

}  // namespace

TiledAxis::TiledAxis(int length) : side_(TileSide(length)) {
  if (side_ == 0) return;
  const int steps = (2 * (length - side_) + side_ - 1) / side_;
  for (int tile = 0; tile <= steps; ++tile) {
    first_.push_back(steps == 0 ? 0 : (length - side_) * tile / steps);
  }
}

double TiledAxis::Weight(int tile, int texel) const {
  const int at = texel - first(tile);
  return at < 0 || at >= side_ ? 0 : std::min(at, side_ - 1 - at) + 1;
}

double TiledAxis::Share(int tile, int texel) const {
  double sum = 0;
  for (int other = 0; other < count(); ++other) sum += Weight(other, texel);
  return Weight(tile, texel) / sum;
}

bool SampleHasRelief(int width, int height) { return std::min(width, height) >= kRingWidth; }

RowSpan RowsOfRelief(int height, RowSpan asked) {
  const TiledAxis down(height);
  RowSpan rows = asked;
  for (int tile = 0; tile < down.count(); ++tile) {
    const int first = down.first(tile), last = first + down.side();
    if (first >= asked.last || last <= asked.first) continue;
    rows.first = std::min(rows.first, first);
    rows.last = std::max(rows.last, last);
  }
  return rows;
}

std::array<std::vector<float>, 2> SlopesOfRelief(std::array<std::span<const float>, 2> slopes,
                                                 int width, int height, double facet_variance,
                                                 RowSpan asked, int threads) {
  const RowSpan rows = RowsOfRelief(height, asked);
  const TiledAxis across(width), down(height);
  std::array<std::vector<float>, 2> relief;
  for (auto& plane : relief) {
    plane.assign(static_cast<size_t>(width) * static_cast<size_t>(asked.last - asked.first), 0);
  }
  for (int r = 0; r < down.count(); ++r) {
    if (down.first(r) >= asked.last || down.first(r) + down.side() <= asked.first) continue;
    std::vector<std::array<cv::Mat, 2>> tiles(static_cast<size_t>(across.count()));
    ForEachPiece(across.count(), threads, [&](int c) {
      const cv::Rect place(across.first(c), down.first(r) - rows.first, across.side(), down.side());
      // Rows go down, where y goes up.
      std::array<cv::Mat, 2>& tile = tiles[static_cast<size_t>(c)];
      tile = Spectrum(PartOf(slopes[0], width, place), -PartOf(slopes[1], width, place))
                 .OfRelief(facet_variance);
      tile[1] *= -1;
    });
    for (int c = 0; c < across.count(); ++c) {
      const std::array<cv::Mat, 2>& tile = tiles[static_cast<size_t>(c)];
      for (size_t i = 0; i < 2; ++i) AddTile(tile[i], across, c, down, r, asked, &relief[i]);
    }
  }
  return relief;
}

}  // namespace glint
