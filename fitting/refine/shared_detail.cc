#include "fitting/refine/shared_detail.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "base/model/photographs.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/log_radiance.h"
#include "fitting/refine/correct_views.h"
#include "fitting/refine/log_picture.h"
#include "fitting/refine/view_sharpness.h"

namespace glint {
namespace {

constexpr int kBlock = 16;          // texels; windows are three of them wide
constexpr size_t kMostSharper = 8;  // all mix three pictures, the sharpest with least noise

std::vector<float> Difference(std::vector<float> a, const std::vector<float>& b) {
  for (size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

// Of a sharper photograph: what both show, luminance without what is coarse, and what the blurred
// one lacks, by channel.
struct Source {
  std::vector<float> shown, lacking;
};

Source SourceOf(const LogPicture& picture, double to_blurred, double to_aim) {
  const std::vector<float> as_blurred = picture.Blurred(to_blurred);
  return {picture.DetailOf(Luminance(as_blurred)), Difference(picture.Blurred(to_aim), as_blurred)};
}

// Blocks of the whole sample of which rows [first_row, first_row + height) are at hand.
struct Blocks {
  explicit Blocks(const SamplePlane& plane)
      : width(plane.width),
        height(plane.height),
        first_row(plane.whole.first_row),
        first(first_row / kBlock),
        across((width + kBlock - 1) / kBlock),
        down((first_row + height + kBlock - 1) / kBlock - first) {}
  int width, height, first_row;
  int first;  // row of blocks
  int across, down;
  size_t at(int row, int column) const {  // rows counted from `first`
    return static_cast<size_t>(row) * static_cast<size_t>(across) + static_cast<size_t>(column);
  }
  size_t count() const { return at(down, 0); }
};

// Upper triangles of the sums of products of n + 1 planes, the last one the blurred photograph's.
std::vector<Eigen::MatrixXd> ProductsOf(const Blocks& blocks,
                                        const std::vector<const float*>& planes, int threads) {
  const auto n = static_cast<Eigen::Index>(planes.size());
  std::vector<Eigen::MatrixXd> products(blocks.count(), Eigen::MatrixXd::Zero(n, n));
  ForEachPiece(blocks.down, threads, [&](int block_row) {
    const int from = std::max(0, (blocks.first + block_row) * kBlock - blocks.first_row);
    const int to =
        std::min(blocks.height, (blocks.first + block_row + 1) * kBlock - blocks.first_row);
    for (int block = 0; block < blocks.across; ++block) {
      Eigen::MatrixXd& sums = products[blocks.at(block_row, block)];
      const int left = block * kBlock, right = std::min(blocks.width, left + kBlock);
      for (int row = from; row < to; ++row) {
        const size_t at = static_cast<size_t>(row) * static_cast<size_t>(blocks.width);
        for (Eigen::Index i = 0; i < n; ++i) {
          for (Eigen::Index j = i; j < n; ++j) {
            const float *a = planes[static_cast<size_t>(i)] + at,
                        *b = planes[static_cast<size_t>(j)] + at;
            float sum = 0;
            for (int column = left; column < right; ++column) sum += a[column] * b[column];
            sums(i, j) += static_cast<double>(sum);
          }
        }
      }
    }
  });
  for (Eigen::MatrixXd& sums : products) {
    sums.triangularView<Eigen::StrictlyLower>() = sums.transpose();
  }
  return products;
}

struct Combination {
  using Coefficients = std::array<float, kMostSharper>;
  std::vector<Coefficients> by_block;  // a
  // Share of the blurred photograph's coarser detail, of each block by those about it.
  double explained = 0;
};

Combination CombinationOf(const Blocks& blocks, const std::vector<Eigen::MatrixXd>& products) {
  Combination found;
  const Eigen::Index n = products[0].rows() - 1;
  // A ridge: of the noise that comes with what is added, of as much as counts as no detail.
  const double noise =
      constants::kLeastHiddenDetail * constants::kLeastHiddenDetail * 9 * kBlock * kBlock;
  double left = 0, all = 0;
  for (int row = 0; row < blocks.down; ++row) {
    for (int column = 0; column < blocks.across; ++column) {
      Eigen::MatrixXd window = Eigen::MatrixXd::Zero(n + 1, n + 1);
      for (int r = std::max(0, row - 1); r <= std::min(blocks.down - 1, row + 1); ++r) {
        for (int c = std::max(0, column - 1); c <= std::min(blocks.across - 1, column + 1); ++c) {
          window += products[blocks.at(r, c)];
        }
      }
      const auto solve = [&](const Eigen::MatrixXd& sums) -> Eigen::VectorXd {
        Eigen::MatrixXd normal = sums.topLeftCorner(n, n);
        normal.diagonal().array() += noise;
        return normal.llt().solve(sums.topRightCorner(n, 1));
      };
      const Eigen::MatrixXd& own = products[blocks.at(row, column)];
      const Eigen::VectorXd by_others = solve(window - own), a = solve(window);
      left += own(n, n) - 2 * by_others.dot(own.topRightCorner(n, 1).col(0)) +
              by_others.dot(own.topLeftCorner(n, n) * by_others);
      all += own(n, n);
      Combination::Coefficients& coefficients = found.by_block.emplace_back();
      for (Eigen::Index k = 0; k < n; ++k) {
        coefficients[static_cast<size_t>(k)] = static_cast<float>(a[k]);
      }
    }
  }
  found.explained = all > 0 ? std::clamp(1 - left / all, 0.0, 1.0) : 0;
  return found;
}

bool BlurIsMeasured(const PhotographSet& set, const RefineOptions& options) {
  return options.measured_blur &&
         std::all_of(set.photographs.begin(), set.photographs.end(),
                     [](const Photograph& photograph) { return photograph.blur_px > 0; });
}

// Of photographs' points, texels².
std::vector<double> BlurVariances(const PhotographSet& set, const RefineOptions& options) {
  std::vector<double> variances;
  for (const RefineView& view : ProblemOf(set).views) {
    variances.push_back(SpreadOf(view, options).variance());
  }
  return variances;
}

// Sharpest first; of equal ones the same whatever the order in which they were given.
std::vector<size_t> BySharpness(const PhotographSet& set, const std::vector<double>& variances) {
  std::vector<size_t> order(variances.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto key = [&](size_t v) {
    const View& view = set.photographs[v].view;
    return std::tie(variances[v], view.camera_in_sample_mm, view.light_in_sample_mm);
  };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
  return order;
}

// Where a texel lies between the middles of blocks.
struct Between {
  Between(int texel, int blocks) {
    const double at = std::clamp((texel + 0.5) / kBlock - 0.5, 0.0, blocks - 1.0);
    first = std::min(static_cast<int>(at), std::max(0, blocks - 2));
    second = std::min(first + 1, blocks - 1);
    share = static_cast<float>(at - first);
  }
  int first, second;
  float share;  // of the second
};

}  // namespace

SharedDetail::SharedDetail(const PhotographSet& middle, const RefineOptions& options, int threads)
    : variances_(BlurVariances(middle, options)) {
  sharper_ = BySharpness(middle, variances_);
  const std::vector<size_t> blurrier(sharper_.begin() + (sharper_.size() + 1) / 2, sharper_.end());
  sharper_.resize((sharper_.size() + 1) / 2);
  if (!BlurIsMeasured(middle, options)) return;
  for (const size_t v : blurrier) {
    if (!(variances_[v] - variances_[sharper_.back()] > constants::kLeastRelativeBlur)) {
      continue;
    }
    const double hidden = HiddenVariance(middle, v, threads);
    if (std::sqrt(hidden) <= constants::kLeastHiddenDetail) continue;
    PhotographSet sharpened = middle;
    blurred_.push_back({v, hidden * (1 - Sharpen(v, threads, &sharpened))});
  }
}

bool SharedDetail::MayLack(const PhotographSet& views, const RefineOptions& options) {
  if (views.photographs.size() < 2) return false;
  if (!BlurIsMeasured(views, options)) return false;
  std::vector<double> variances = BlurVariances(views, options);
  std::sort(variances.begin(), variances.end());
  return variances.back() - variances[(variances.size() + 1) / 2 - 1] >
         constants::kLeastRelativeBlur;
}

// e²: of the detail that the blur of `photograph` takes from sharper ones, the mean over them.
double SharedDetail::HiddenVariance(const PhotographSet& set, size_t photograph,
                                    int threads) const {
  std::vector<double> taken(sharper_.size(), 0.0), shown(sharper_.size(), 0.0);
  ForEachPiece(static_cast<int>(sharper_.size()), threads, [&](int piece) {
    const size_t u = sharper_[static_cast<size_t>(piece)];
    const double more = variances_[photograph] - variances_[u];
    const LogPicture picture(set.photographs[u], set.plane.width, set.plane.height);
    if (std::none_of(picture.usable.begin(), picture.usable.end(), [](float x) { return x > 0; })) {
      return;
    }
    shown[static_cast<size_t>(piece)] = 1;
    if (!(more > 0)) return;
    const std::vector<float> lacking = Luminance(Difference(picture.rgb, picture.Blurred(more)));
    double sum = 0, count = 0;
    for (size_t t = 0; t < lacking.size(); ++t) {
      sum += static_cast<double>(lacking[t]) * static_cast<double>(lacking[t]);
      count += static_cast<double>(picture.usable[t]);
    }
    taken[static_cast<size_t>(piece)] = sum / count;
  });
  const double photographs = std::accumulate(shown.begin(), shown.end(), 0.0);
  return photographs > 0 ? std::accumulate(taken.begin(), taken.end(), 0.0) / photographs : 0;
}

int SharedDetail::RowsAbout() const {
  if (blurred_.empty()) return 0;
  // Of the two blocks between which a texel lies, the window of the farther one.
  constexpr int kOfWindow = 3 * kBlock;
  return kOfWindow + kDetailReach + PointSpread(constants::kMostBlurVariance).reach();
}

double SharedDetail::Sharpen(size_t photograph, int threads, PhotographSet* set) const {
  const int width = set->plane.width, height = set->plane.height;
  const double own = variances_[photograph], aim = variances_[sharper_.back()];
  const std::span<const size_t> used =
      std::span(sharper_).first(std::min(sharper_.size(), kMostSharper));
  std::vector<Source> sources(used.size());
  ForEachPiece(static_cast<int>(used.size()), threads, [&](int piece) {
    const size_t u = used[static_cast<size_t>(piece)];
    sources[static_cast<size_t>(piece)] = SourceOf(LogPicture(set->photographs[u], width, height),
                                                   own - variances_[u], aim - variances_[u]);
  });
  Photograph& blurred = set->photographs[photograph];
  const LogPicture picture(blurred, width, height);
  const std::vector<float> shown = picture.DetailOf(Luminance(picture.rgb));
  std::vector<const float*> planes;
  for (Source& source : sources) {
    for (size_t t = 0; t < shown.size(); ++t) source.shown[t] *= picture.usable[t];
    planes.push_back(source.shown.data());
  }
  planes.push_back(shown.data());
  const Blocks blocks(set->plane);
  const Combination combination = CombinationOf(blocks, ProductsOf(blocks, planes, threads));

  const size_t texels = shown.size();
  // What was not clipped does not become so.
  const float most = blurred.ldr
                         ? std::nextafter(static_cast<float>(constants::kClippedRadiance), 0.0f)
                         : std::numeric_limits<float>::infinity();
  const auto at = [&](int row, int column) -> const Combination::Coefficients& {
    return combination.by_block[blocks.at(row, column)];
  };
  ForEachPiece(height, threads, [&](int row) {
    const Between down(row + blocks.first_row - blocks.first * kBlock, blocks.down);
    for (int column = 0; column < width; ++column) {
      const size_t t =
          static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
      if (picture.usable[t] == 0) continue;
      const Between across(column, blocks.across);
      float lacking[3] = {};
      for (size_t k = 0; k < sources.size(); ++k) {
        const float above = (1 - across.share) * at(down.first, across.first)[k] +
                            across.share * at(down.first, across.second)[k];
        const float below = (1 - across.share) * at(down.second, across.first)[k] +
                            across.share * at(down.second, across.second)[k];
        const float a = (1 - down.share) * above + down.share * below;
        for (size_t c = 0; c < 3; ++c) lacking[c] += a * sources[k].lacking[c * texels + t];
      }
      for (size_t c = 0; c < 3; ++c) {
        float& radiance = blurred.rgb[c * texels + t];
        if (!(radiance < most)) continue;
        const float log = picture.rgb[c * texels + t] + lacking[c];
        radiance = std::clamp(std::exp(log) - static_cast<float>(kLogOffset), 0.0f, most);
      }
    }
  });
  return combination.explained;
}

void SharedDetail::AddTo(PhotographSet* rows, int threads) const {
  for (const Blurred& one : blurred_) Sharpen(one.photograph, threads, rows);
  Describe(rows);
}

void SharedDetail::Describe(PhotographSet* set) const {
  for (const Blurred& one : blurred_) {
    Photograph& photograph = set->photographs[one.photograph];
    photograph.hidden_variance = one.hidden_variance;
    photograph.spread_variance = variances_[sharper_.back()];
  }
}

}  // namespace glint
