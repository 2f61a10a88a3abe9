// Which photographs go together, where many seem not to.
//
// Lens and poses are solved for from all photographs at first, and those that do not fit leave one
// after the other. Two that an app straightened or cropped can bend the first solution so far that
// good ones leave instead. So where a third leaves, every two photographs are left out in turn: the
// solution that explains most of the others is the right one, as Fischler and Bolles' consensus
// ("Random Sample Consensus", Communications of the ACM 24, 1981).
#pragma once

#include <string>
#include <vector>

#include "calib/bundle/bundle.h"

namespace glint {

struct OddPhoto {
  size_t photo = 0;    // of the problem
  std::string reason;  // as PhotoEstimate::rejected, with what explains it
};

// Photographs that are inconsistent with the solution that most agree on; none where `result`,
// which solves `problem` under `options`, is it, where less than a third was rejected, or of more
// than twelve or fewer than six photographs. The same for any number of threads.
std::vector<OddPhoto> OddPhotos(const BundleProblem& problem, const BundleOptions& options,
                                const BundleResult& result, int threads);

}  // namespace glint
