// How the photographs show a sample as a whole, and which of its texels are shinier than it.
//
// Substances of one colour can differ in nothing but their gloss: the pores of a varnished wood,
// joints, matte print on glossy paper. In the highlight of a photograph such texels are darker than
// what surrounds them, far from it brighter, and the median over photographs shows nothing of it.
// With I_v what photograph v shows of a texel, M_v its median over the texels about that place, and
// E_v what falls on it there, a texel's gloss is the slope β of
//   log(I_v/M_v) = a + β·log(M_v/E_v),   over the photographs, by least squares:
// −1: no highlight where the others have one; 0: as the others; above: a brighter one.
// Nine photographs tell single texels' slopes badly: what is taken is the mean of β ~ N(0, τ²)
// given the slope found and the variance of its error, s²/Σ(log(M_v/E_v) − mean)², with τ² and s²
// of the sample.
#pragma once

#include <vector>

#include "fitting/refine/refine.h"

namespace glint {

class SampleLook {
 public:
  // `problem`: texels that stand for the sample, or all.
  SampleLook(const RefineProblem& problem, int threads);

  // Whether gloss varies over the sample.
  bool tells() const { return variance_ > 0; }

  // Of each texel of `problem`, which has the same views: β. 0 of what two photographs or fewer
  // show. Does not depend on the number of threads.
  std::vector<float> GlossOf(const RefineProblem& problem, int threads) const;

 private:
  struct Typical {
    float log_radiance;  // log(M_v + 0.01); NaN: not seen there
    float highlight;     // log(M_v/E_v)
  };
  struct Line {
    float slope = 0;
    float information = 0;  // Σ (log(M_v/E_v) − mean)²; 0: too few photographs show it
    float squares = 0;      // of what it leaves of the departures …
    int freedom = 0;        // … and their degrees of freedom
  };
  Typical TypicalAt(size_t view, double x, double y) const;
  Line LineOf(const RefineProblem& problem, size_t texel) const;
  std::vector<Line> LinesOf(const RefineProblem& problem, int threads) const;
  void LearnVariances(const std::vector<Line>& lines);

  std::vector<std::vector<Typical>> typical_;  // by view: of the middles of cells, row by row
  double noise_ = 0;                           // s²
  double variance_ = 0;                        // τ²
};

}  // namespace glint
