#include "calib/validation/consensus.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/errors/errors.h"
#include "base/parallel/parallel.h"
#include "calib/validation/misfit.h"

namespace glint {
namespace {

constexpr size_t kFewestPhotos = 6,
                 kMostPhotos = 12;  // 15 to 66 pairs, of half a second each

size_t Accepted(const BundleResult& result) {
  return static_cast<size_t>(
      std::count_if(result.photos.begin(), result.photos.end(),
                    [](const PhotoEstimate& photo) { return photo.rejected.empty(); }));
}

std::optional<BundleResult> Solve(const BundleProblem& problem, const BundleOptions& options) {
  try {
    return AdjustBundle(problem, options);
  } catch (const Error&) {
    return std::nullopt;
  }
}

using Pair = std::pair<size_t, size_t>;

std::optional<BundleResult> SolveWithout(BundleProblem problem, const BundleOptions& options,
                                         const Pair& pair) {
  problem.photos.erase(problem.photos.begin() + static_cast<std::ptrdiff_t>(pair.second));
  problem.photos.erase(problem.photos.begin() + static_cast<std::ptrdiff_t>(pair.first));
  return Solve(problem, options);
}

// The solution without those two whose absence leaves the least residuals of all others; none where
// no more photographs go with it than with `result`. Nothing else need be rejected to tell.
std::optional<BundleResult> BestWithoutTwo(const BundleProblem& problem,
                                           const BundleOptions& options, const BundleResult& result,
                                           int threads) {
  BundleOptions plain = options;
  plain.reject = false;
  std::vector<Pair> pairs;
  for (size_t a = 0; a < problem.photos.size(); ++a) {
    for (size_t b = a + 1; b < problem.photos.size(); ++b) pairs.emplace_back(a, b);
  }
  std::vector<double> rms_px(pairs.size(), std::numeric_limits<double>::infinity());
  ForEachPiece(static_cast<int>(pairs.size()), threads, [&](int piece) {
    const auto i = static_cast<size_t>(piece);
    if (const auto found = SolveWithout(problem, plain, pairs[i])) rms_px[i] = found->rms_px;
  });
  const auto least = std::min_element(rms_px.begin(), rms_px.end());
  const Pair& best = pairs[static_cast<size_t>(least - rms_px.begin())];
  std::optional<BundleResult> found = SolveWithout(problem, options, best);
  return found && Accepted(*found) > Accepted(result) ? std::move(found) : std::nullopt;
}

}  // namespace

std::vector<OddPhoto> OddPhotos(const BundleProblem& problem, const BundleOptions& options,
                                const BundleResult& result, int threads) {
  const size_t count = problem.photos.size(), rejected = count - Accepted(result);
  if (count < kFewestPhotos || count > kMostPhotos || 3 * rejected < count) return {};
  const std::optional<BundleResult> best = BestWithoutTwo(problem, options, result, threads);
  if (!best) return {};
  BundleProblem known = problem;
  for (size_t c = 0; c < known.cameras.size(); ++c) {
    if (best->cameras[c].photos > 0) known.cameras[c].known = best->cameras[c].camera;
  }
  BundleOptions poses = options;
  if (best->bend) {
    known.bend = best->bend;
    poses.bend = false;
  }
  const std::optional<BundleResult> all = Solve(known, poses);
  std::vector<OddPhoto> odd;
  for (size_t i = 0; all && i < count; ++i) {
    if (all->photos[i].rejected.empty()) continue;
    const auto view = ExplainByOtherView(*all, all->photos[i]);
    odd.push_back({i, all->photos[i].rejected + (view ? "; " + InWords(*view) : "")});
  }
  return odd;
}

}  // namespace glint
